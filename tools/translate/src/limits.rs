//! The default limits of WebGPU (<https://www.w3.org/TR/webgpu/#limits>).

use naga::{
    AddressSpace, Binding, ImageClass, ShaderStage, TypeInner, proc::Layouter, valid::GlobalUse,
};

use crate::Shader;

/// What one entry point uses.
#[derive(Default)]
struct Used {
    sampled: usize,
    samplers: usize,
    storage_textures: usize,
    storage_buffers: usize,
    uniform_buffers: usize,
    largest_uniform: u32,
    workgroup_bytes: u32,
    groups: u32,
    outputs: usize,
    attributes: usize,
}

fn used(shader: &Shader, entry: usize) -> Used {
    let (module, info) = (&shader.module, shader.info.get_entry_point(entry));
    let mut layouter = Layouter::default();
    layouter.update(module.to_ctx()).expect("valid");
    let mut used = Used::default();
    for (handle, global) in module.global_variables.iter() {
        if info[handle] == GlobalUse::empty() {
            continue;
        }
        let size = layouter[global.ty].size;
        if let Some(binding) = &global.binding {
            used.groups = used.groups.max(binding.group + 1);
        }
        match global.space {
            AddressSpace::Uniform => {
                used.uniform_buffers += 1;
                used.largest_uniform = used.largest_uniform.max(size);
            }
            AddressSpace::Storage { .. } => used.storage_buffers += 1,
            AddressSpace::WorkGroup => used.workgroup_bytes += size,
            AddressSpace::Handle => match module.types[global.ty].inner {
                TypeInner::Image {
                    class: ImageClass::Storage { .. },
                    ..
                } => {
                    used.storage_textures += 1;
                }
                TypeInner::Image { .. } => used.sampled += 1,
                TypeInner::Sampler { .. } => used.samplers += 1,
                _ => {}
            },
            _ => {}
        }
    }
    let function = &module.entry_points[entry].function;
    let located = |ty, binding: Option<&Binding>| match (&module.types[ty].inner, binding) {
        (_, Some(Binding::Location { .. })) => 1,
        (TypeInner::Struct { members, .. }, None) => members
            .iter()
            .filter(|member| matches!(member.binding, Some(Binding::Location { .. })))
            .count(),
        _ => 0,
    };
    used.attributes = function
        .arguments
        .iter()
        .map(|a| located(a.ty, a.binding.as_ref()))
        .sum();
    used.outputs = function
        .result
        .as_ref()
        .map_or(0, |r| located(r.ty, r.binding.as_ref()));
    used
}

/// The limits that a shader exceeds.
pub fn exceeded(shader: &Shader) -> Vec<String> {
    let mut found = Vec::new();
    for (index, entry) in shader.module.entry_points.iter().enumerate() {
        let used = used(shader, index);
        let invocations: u32 = entry.workgroup_size.iter().product();
        let [x, y, z] = entry.workgroup_size;
        let is_vertex = entry.stage == ShaderStage::Vertex;
        let is_fragment = entry.stage == ShaderStage::Fragment;
        let variables = if is_fragment { used.attributes } else { 0 };
        let varyings = if is_vertex { used.outputs } else { variables };
        let attributes = if is_vertex { used.attributes } else { 0 };
        let targets = if is_fragment { used.outputs } else { 0 };
        let checks = [
            ("bind groups", used.groups as usize, 4),
            ("sampled textures", used.sampled, 16),
            ("samplers", used.samplers, 16),
            ("storage textures", used.storage_textures, 4),
            ("storage buffers", used.storage_buffers, 8),
            ("uniform buffers", used.uniform_buffers, 12),
            (
                "bytes of a uniform buffer",
                used.largest_uniform as usize,
                65_536,
            ),
            (
                "bytes of workgroup storage",
                used.workgroup_bytes as usize,
                16_384,
            ),
            ("invocations of a workgroup", invocations as usize, 256),
            ("width or height of a workgroup", x.max(y) as usize, 256),
            ("depth of a workgroup", z as usize, 64),
            ("variables between stages", varyings, 16),
            ("vertex attributes", attributes, 16),
            ("color attachments", targets, 8),
        ];
        for (what, count, limit) in checks {
            if count > limit {
                found.push(format!(
                    "{}: {count} {what}, {limit} are allowed",
                    entry.name
                ));
            }
        }
    }
    found
}
