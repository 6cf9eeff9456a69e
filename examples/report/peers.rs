//! Times of other crates in the same app and run: `benches/peers`, a separate workspace.

use std::process::Command;

use crate::{Run, rig};

pub fn measure(run: &Run) -> Result<(), String> {
    if run.quick {
        run.say("left out: --quick does not build the other crates");
        return run.save("peer_times", &rig::times());
    }
    let manifest = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/peers/Cargo.toml");
    let file = std::env::temp_dir().join("bevy_comics_peer_times.csv");
    let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".into());
    // A separate target folder, unless the caller sets one.
    let target = std::env::var_os("PEERS_TARGET_DIR").map_or_else(
        || concat!(env!("CARGO_MANIFEST_DIR"), "/benches/peers/target").into(),
        std::path::PathBuf::from,
    );
    let status = Command::new(cargo)
        .args([
            "run",
            "--locked",
            "--quiet",
            "--manifest-path",
            manifest,
            "--",
            "times",
        ])
        .arg(&file)
        .args([run.rounds, run.frames].map(|n| n.to_string()))
        .env("CARGO_TARGET_DIR", target)
        .status()
        .map_err(|error| format!("cargo: {error}"))?;
    if !status.success() {
        return Err("the other crates were not measured; their output is above".into());
    }
    let table = crate::table::Table::load(&file)?;
    run.save("peer_times", &table)
}
