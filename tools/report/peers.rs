//! Times of other crates in the same app and run: `tools/peers`, a separate workspace.

use std::process::Command;

use crate::{Run, rig};

/// A variable with the path of the program, where it is built already.
const PROGRAM: &str = "PEERS_PROGRAM";

pub fn measure(run: &Run) -> Result<(), String> {
    let built = std::env::var_os(PROGRAM);
    if run.quick && built.is_none() {
        run.say("left out: --quick does not build the other crates");
        return run.save("peer_times", &rig::times());
    }
    let file = std::env::temp_dir().join("bevy_comics_peer_times.csv");
    let status = built
        .map_or_else(through_cargo, Command::new)
        .arg("times")
        .arg(&file)
        .args([run.rounds, run.frames].map(|n| n.to_string()))
        .status()
        .map_err(|error| format!("the other crates do not start: {error}"))?;
    if !status.success() {
        return Err("the other crates were not measured; their output is above".into());
    }
    let table = crate::table::Table::load(&file)?;
    run.save("peer_times", &table)
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
