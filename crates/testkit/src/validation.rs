//! Vulkan's validation layer: on where the variable `VULKAN_VALIDATION` is set, as
//! `scripts/validate` does. On Debian it is in the package `vulkan-validationlayers`.

use std::{
    sync::{Mutex, Once},
    thread,
};

/// What the layer said and nobody has read.
static MESSAGES: Mutex<Vec<String>> = Mutex::new(Vec::new());

/// The name of the current thread: a test has a thread with its name.
fn this_thread() -> String {
    thread::current().name().unwrap_or("without a name").into()
}

/// Keeps warnings and errors of the driver, with the thread that called it.
struct Keeper;

/// Whether a message says that something is wrong. Advice on performance does not: shaders of
/// vertices may compute what their fragments do not read. Nor do the names of objects, which follow
/// a message on a line of their own, nor that layers older than 2023 do not know the number of WGSL
/// in shaders compiled from a text.
fn is_fault(message: &str) -> bool {
    !message.starts_with("PERFORMANCE")
        && !message.starts_with('\t')
        && !message.contains("Invalid source language operand: 10")
}

impl log::Log for Keeper {
    fn enabled(&self, metadata: &log::Metadata) -> bool {
        metadata.level() <= log::Level::Warn && metadata.target().starts_with("wgpu_hal::vulkan")
    }

    fn log(&self, record: &log::Record) {
        let text = record.args().to_string();
        if self.enabled(record.metadata()) && is_fault(&text) {
            let message = format!("{} on thread {}: {text}", record.level(), this_thread());
            let mut messages = MESSAGES.lock().expect("no panic while it is held");
            messages.push(message);
        }
    }

    fn flush(&self) {}
}

pub fn is_wanted() -> bool {
    std::env::var_os("VULKAN_VALIDATION").is_some()
}

/// The flags of an instance. Names of resources stay in wgpu: the Vulkan loader (1.3.239) looks for
/// the device of a named resource in a list that another test may be changing.
pub fn instance_flags() -> wgpu::InstanceFlags {
    let flags =
        wgpu::InstanceFlags::DISCARD_HAL_LABELS | wgpu::InstanceFlags::VALIDATION_INDIRECT_CALL;
    if !is_wanted() {
        return flags;
    }
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        log::set_logger(&Keeper).expect("tests have no other logger");
        log::set_max_level(log::LevelFilter::Warn);
    });
    // Without the debug flag, the layer has nobody to tell, and prints its messages.
    flags | wgpu::InstanceFlags::VALIDATION | wgpu::InstanceFlags::DEBUG
}

/// Takes the messages so far.
pub fn messages() -> Vec<String> {
    std::mem::take(&mut MESSAGES.lock().expect("no panic while it is held"))
}

/// Whether the layer is loaded into this process; `None` where the system does not say.
pub fn is_loaded() -> Option<bool> {
    let maps = std::fs::read_to_string("/proc/self/maps").ok()?;
    Some(maps.contains("VkLayer_khronos_validation"))
}

/// Panics with all messages if the layer has said anything, in whichever test of this process: the
/// threads in the text tell which.
pub fn check() {
    let messages = messages();
    assert!(
        messages.is_empty(),
        "validation, found by thread {}:\n{}",
        this_thread(),
        messages.join("\n")
    );
}
