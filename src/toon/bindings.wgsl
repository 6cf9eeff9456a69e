#define_import_path bevy_comics::toon::bindings

// The uniform of the toon material.

#import bevy_comics::toon::{
    detail::Detail,
    proxy::Proxy,
    stylized_highlight::StylizedHighlight,
    light::ToonLight,
    rim::Rim,
    ramp::Ramp,
}

struct Toon {
    // First, since the size of the next one is not a multiple of 16 bytes.
    detail: Detail,
    light: ToonLight,
    proxy: Proxy,
    stylized_highlight: StylizedHighlight,
    rim: Rim,
    // Its length depends on the variant of the shader.
    ramp: Ramp,
}

@group(#{MATERIAL_BIND_GROUP}) @binding(100) var<uniform> toon: Toon;
