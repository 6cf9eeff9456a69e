//! The shipped WGSL, composed as the engine composes it.

use std::{
    collections::HashMap,
    fs,
    path::{Path, PathBuf},
};

use naga_oil::compose::{
    ComposableModuleDescriptor, Composer, NagaModuleDescriptor, ShaderDefValue,
    get_preprocessor_data,
};

/// Every WGSL file of the crate.
pub fn files() -> Vec<PathBuf> {
    fn walk(folder: &Path, found: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).expect("a folder of the crate") {
            let path = entry.expect("entry").path();
            if path.is_dir() {
                walk(&path, found);
            } else if path.extension().is_some_and(|e| e == "wgsl") {
                found.push(path);
            }
        }
    }
    let mut found = Vec::new();
    walk(
        &Path::new(env!("CARGO_MANIFEST_DIR")).join("src"),
        &mut found,
    );
    found.sort();
    found
}

/// Composes an entry point: `source` may import every module of the crate.
pub fn module(source: &str, defs: &[&str]) -> Result<wgpu::naga::Module, String> {
    let mut modules = HashMap::new();
    for path in files() {
        let text = fs::read_to_string(&path).expect("a WGSL file");
        let (name, imports, _) = get_preprocessor_data(&text);
        if let Some(name) = name {
            modules.insert(name, (text, imports));
        }
    }
    let (_, wanted, _) = get_preprocessor_data(source);
    let mut composer = Composer::default();
    composer.capabilities = wgpu::naga::valid::Capabilities::all();
    for import in wanted {
        add(&mut composer, &modules, &import.import)?;
    }
    let shader_defs = defs
        .iter()
        .map(|def| ((*def).to_owned(), ShaderDefValue::Bool(true)))
        .collect();
    composer
        .make_naga_module(NagaModuleDescriptor {
            source,
            file_path: "entry.wgsl",
            shader_defs,
            ..Default::default()
        })
        .map_err(|error| error.emit_to_string(&composer))
}

type Modules = HashMap<String, (String, Vec<naga_oil::compose::ImportDefinition>)>;

fn add(composer: &mut Composer, modules: &Modules, name: &str) -> Result<(), String> {
    if composer.contains_module(name) {
        return Ok(());
    }
    let (text, imports) = modules
        .get(name)
        .ok_or_else(|| format!("no module {name:?} in the crate"))?;
    for import in imports {
        add(composer, modules, &import.import)?;
    }
    composer
        .add_composable_module(ComposableModuleDescriptor {
            source: text,
            file_path: name,
            ..Default::default()
        })
        .map(|_| ())
        .map_err(|error| error.emit_to_string(composer))
}
