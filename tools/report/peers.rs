//! Times of other crates in the same app and run: `tools/peers`, a separate workspace.

use std::process::Command;

use crate::{Run, rig, table::Table};

/// A variable with the path of the program, where it is built already.
const PROGRAM: &str = "PEERS_PROGRAM";

pub fn measure(run: &Run) -> Result<(), String> {
    if run.quick && std::env::var_os(PROGRAM).is_none() {
        run.say("left out: --quick does not build the other crates");
        return run.save("peer_times", &rig::times());
    }
    run.save("peer_times", &measured("times", run.rounds, run.frames)?)
}

/// Frames with many objects; no rows where that is left out.
pub fn many_objects(run: &Run) -> Result<(), String> {
    let table = if run.quick || std::env::var_os(PROGRAM).is_some() {
        run.say("left out: the other crates");
        Table::new("objects,variant,round,whole")
    } else {
        measured("many", 3, 9)?
    };
    run.save("peer_object_times", &table)
}

/// What the program measures.
fn measured(mode: &str, rounds: usize, frames: usize) -> Result<Table, String> {
    let file = std::env::temp_dir().join(format!("bevy_comics_peers_{mode}.csv"));
    let built = std::env::var_os(PROGRAM);
    let status = built
        .map_or_else(through_cargo, Command::new)
        .arg(mode)
        .arg(&file)
        .args([rounds, frames].map(|n| n.to_string()))
        .status()
        .map_err(|error| format!("the other crates do not start: {error}"))?;
    if !status.success() {
        return Err("the other crates were not measured; their output is above".into());
    }
    Table::load(&file)
}

/// Builds the program and starts it.
fn through_cargo() -> Command {
    let manifest = concat!(env!("CARGO_MANIFEST_DIR"), "/tools/peers/Cargo.toml");
    // A separate target folder, unless the caller sets one.
    let target = std::env::var_os("PEERS_TARGET_DIR").map_or_else(
        || concat!(env!("CARGO_MANIFEST_DIR"), "/tools/peers/target").into(),
        std::path::PathBuf::from,
    );
    let mut cargo = Command::new(std::env::var("CARGO").unwrap_or_else(|_| "cargo".into()));
    cargo
        .args(["run", "--locked", "--quiet", "--manifest-path", manifest])
        .arg("--")
        .env("CARGO_TARGET_DIR", target);
    cargo
}
