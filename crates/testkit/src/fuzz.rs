//! Untrusted texts: nearly right, and wrong somewhere. What reads them must neither panic, nor take
//! long, nor ask for much memory.

#![expect(unsafe_code, reason = "the trait of allocators is unsafe")]

use std::{
    alloc::{GlobalAlloc, Layout, System},
    cell::Cell,
    ops::Range,
    str::Split,
    time::{Duration, Instant},
};

use crate::scenes::noise::Random;

thread_local! {
    /// Bytes that this thread has allocated and not freed, and the most of them.
    static BYTES: Cell<(isize, isize)> = const { Cell::new((0, 0)) };
}

/// The system's allocator, which counts the bytes of every thread. A binary that calls [`check`]
/// needs it as its `#[global_allocator]`.
pub struct Counting;

fn count(bytes: isize) {
    // A thread that ends has no counter any more.
    let _ = BYTES.try_with(|cell| {
        let (live, most) = cell.get();
        let live = live + bytes;
        cell.set((live, most.max(live)));
    });
}

// SAFETY: every call goes to the system's allocator as it came.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size() as isize);
        // SAFETY: as promised by the caller.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        count(-(layout.size() as isize));
        // SAFETY: as promised by the caller.
        unsafe { System.dealloc(at, layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count(layout.size() as isize);
        // SAFETY: as promised by the caller.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, at: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count(size as isize - layout.size() as isize);
        // SAFETY: as promised by the caller.
        unsafe { System.realloc(at, layout, size) }
    }
}

/// How many inputs are tried: the variable `FUZZ_CASES`, else 2000.
pub fn cases() -> usize {
    let given = std::env::var("FUZZ_CASES").ok();
    given.and_then(|text| text.parse().ok()).unwrap_or(2000)
}

/// The bytes that reading a text may take at most, as `docs/style-format.md` states: a mebibyte,
/// and 256 for each of its own.
fn most_bytes(text: &str) -> usize {
    (1 << 20) + 256 * text.len()
}

/// Prints a text if reading it panics.
struct Shown<'a>(&'a str);

impl Drop for Shown<'_> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            println!("the text was: {:?}", self.0);
        }
    }
}

/// Runs `read` on a text. Panics if it panics, takes longer than a second, or allocates more than
/// stated.
pub fn check(text: &str, read: impl FnOnce(&str)) {
    let _shown = Shown(text);
    let before = BYTES.get().0;
    BYTES.set((before, before));
    let start = Instant::now();
    read(text);
    let took = start.elapsed();
    let bytes = BYTES.get().1 - before;
    assert!(took < Duration::from_secs(1), "it took {took:?}");
    let most = most_bytes(text);
    assert!(bytes <= most as isize, "{bytes} bytes, {most} are allowed");
}

/// Changes command lines and reads them. Each must be read, or refused with a message, within the
/// limits of
/// [`check`]. More than one in twenty must be read, and as many refused, so that both paths are tested.
///
/// `right` has correct command lines, with an argument on each line. `read` returns `None` where
/// only help is asked for. `assert_usable` panics if what was read is outside its ranges.
pub fn check_command_lines<T>(
    seed: u64,
    right: &[&str],
    read: impl Fn(Split<'_, char>) -> Result<Option<T>, String>,
    assert_usable: impl Fn(&T),
) {
    let mut texts = Texts::new(seed, right.iter().map(|&line| line.to_owned()));
    let (mut accepted, mut refused) = (0, 0);
    for _ in 0..cases() {
        check(&texts.next_text(), |text| match read(text.split('\n')) {
            Ok(Some(arguments)) => {
                accepted += 1;
                assert_usable(&arguments);
            }
            Ok(None) => {}
            Err(message) => {
                refused += 1;
                assert!(!message.is_empty());
            }
        });
    }
    assert!(
        accepted * 20 > cases() && refused * 20 > cases(),
        "{accepted}, {refused}"
    );
}

/// What text may contain that is wrong, or just right, between spaces.
const WORDS: &str = "NaN inf -inf 1e999 -0.0 0 -1 4294967296 18446744073709551616 1e-45 \
    3.4028236e38 true None Some( () ((((((((((((((((( )))) [[[[[[[[ ] { } \" ' \\u{0} \\ r#\" \"# /* \
    */ // \u{feff} \u{1f600} \u{202e} : , # #ffffffff version:2, version:3, .. ../ /etc/ file:// \
    C:\\";

/// Texts that are made of right ones.
pub struct Texts {
    random: Random,
    right: Vec<String>,
    words: Vec<&'static str>,
}

/// A random number below `end`, which has at most 24 bits.
fn below(random: &mut Random, end: usize) -> usize {
    ((random.unit() * end as f32) as usize).min(end.saturating_sub(1))
}

/// A place between two characters.
fn place(random: &mut Random, text: &str) -> usize {
    let at = below(random, text.len() + 1);
    (0..=at)
        .rev()
        .find(|at| text.is_char_boundary(*at))
        .unwrap_or(0)
}

/// Two places in their order, not far apart.
fn span(random: &mut Random, text: &str) -> Range<usize> {
    let start = place(random, text);
    let end = (start + below(random, 60)).min(text.len());
    let end = (end..=text.len()).find(|at| text.is_char_boundary(*at));
    start..end.unwrap_or(text.len())
}

impl Texts {
    pub fn new(seed: u64, right: impl IntoIterator<Item = String>) -> Self {
        let right: Vec<_> = right.into_iter().collect();
        assert!(!right.is_empty(), "texts are made of others");
        Self {
            random: Random::new(seed),
            right,
            words: WORDS.split(' ').collect(),
        }
    }

    fn change(&mut self, text: &mut String) {
        let random = &mut self.random;
        let at = span(random, text);
        match below(random, 8) {
            0 => text.replace_range(at, ""),
            1 => {
                let twice = text[at.clone()].to_owned();
                text.insert_str(at.end, &twice);
            }
            2 => text.truncate(at.start),
            3 => {
                // A part of another text.
                let other = &self.right[below(random, self.right.len())];
                let part = span(random, other);
                text.replace_range(at, &other[part]);
            }
            4 => {
                let many = 1 << below(random, 12);
                let word = self.words[below(random, self.words.len())];
                text.insert_str(at.start, &word.repeat(many));
            }
            5 => {
                let code = below(random, 0x11_0000) as u32;
                text.insert(at.start, char::from_u32(code).unwrap_or('\u{fffd}'));
            }
            _ => {
                let word = self.words[below(random, self.words.len())];
                text.replace_range(at, word);
            }
        }
    }

    /// The next text: a right one with up to six changes.
    pub fn next_text(&mut self) -> String {
        let right = below(&mut self.random, self.right.len());
        let mut text = self.right[right].clone();
        for _ in 0..below(&mut self.random, 7) {
            self.change(&mut text);
        }
        text
    }
}
