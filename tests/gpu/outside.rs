//! Crates outside the repository, built with the engine that our own tests are built with.

use std::{
    env, fs,
    path::{Path, PathBuf},
    process::Command,
};

pub const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// A crate in a temporary folder, which is removed with it unless a test failed.
pub struct OutsideCrate {
    folder: PathBuf,
    target: PathBuf,
}

impl OutsideCrate {
    /// A crate with these source files, by their paths under `src`. It depends on this crate, on
    /// the test kit, on the dependencies of ours that are listed, and on everything that our tests
    /// depend on: so the engine has the same features, and is not built a second time.
    pub fn new(name: &str, dependencies: &[&str], files: &[(&str, &str)]) -> Self {
        let folder = env::temp_dir().join(format!("bevy-comics-{name}-{}", std::process::id()));
        let manifest =
            fs::read_to_string(Path::new(ROOT).join("Cargo.toml")).expect("our manifest");
        let own = section(&manifest, "dependencies");
        let listed: String = dependencies
            .iter()
            .map(|name| {
                let start = format!("{name} = ");
                let line = own.lines().find(|line| line.starts_with(&start));
                line.unwrap_or_else(|| panic!("we do not depend on {name}"))
                    .to_owned()
                    + "\n"
            })
            .collect();
        let text = format!(
            "[package]\nname = {name:?}\nversion = \"0.1.0\"\nedition = \"2024\"\n\n[workspace]\n\n\
             [dependencies]\nbevy = {{ version = \"*\", default-features = false }}\n{listed}{}\n\n\
             [profile.dev]\n{}\n\n[profile.dev.package.\"*\"]\n{}\n",
            section(&manifest, "dev-dependencies")
                .replace("path = \"", &format!("path = \"{ROOT}/")),
            section(&manifest, "profile.dev"),
            section(&manifest, "profile.dev.package.\"*\""),
        );
        write(&folder.join("Cargo.toml"), &text);
        let lock = fs::read_to_string(Path::new(ROOT).join("Cargo.lock")).expect("our lock file");
        write(&folder.join("Cargo.lock"), &lock);
        for (path, text) in files {
            write(&folder.join("src").join(path), text);
        }
        let target = env::current_exe()
            .expect("this test")
            .ancestors()
            .find(|path| path.file_name().is_some_and(|name| name == "debug"))
            .and_then(Path::parent)
            .expect("the target folder")
            .to_owned();
        Self { folder, target }
    }

    /// The folder of the crate's manifest; programs run in it.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Runs cargo in the crate's folder, which must succeed; what it printed.
    pub fn cargo(&self, arguments: &[&str]) -> String {
        let output = Command::new(env::var("CARGO").unwrap_or_else(|_| "cargo".into()))
            .args(arguments)
            .current_dir(&self.folder)
            .env("CARGO_TARGET_DIR", &self.target)
            // Programs keep the user's settings as they are.
            .env("XDG_CONFIG_HOME", &self.folder)
            .output()
            .expect("cargo runs");
        let printed = String::from_utf8_lossy(&output.stdout).into_owned();
        assert!(
            output.status.success(),
            "cargo {arguments:?}\n{printed}{}",
            String::from_utf8_lossy(&output.stderr)
        );
        printed
    }
}

impl Drop for OutsideCrate {
    fn drop(&mut self) {
        if !std::thread::panicking() {
            fs::remove_dir_all(&self.folder).expect("the folder goes");
        }
    }
}

fn write(path: &Path, text: &str) {
    fs::create_dir_all(path.parent().expect("a folder")).expect("created");
    fs::write(path, text).expect("written");
}

/// The section of our manifest under a heading.
fn section(manifest: &str, heading: &str) -> String {
    let (_, rest) = manifest
        .split_once(&format!("[{heading}]\n"))
        .expect("the section");
    rest.lines()
        .take_while(|line| !line.starts_with('['))
        .collect::<Vec<_>>()
        .join("\n")
}
