#define_import_path bevy_comics::cartoon::bindings

// The uniform of the cartoon material.

#import bevy_comics::cartoon::{
    detail::Detail,
    form::Form,
    glint::Glint,
    light::CartoonLight,
    light_rim::Rim,
    ramp::Ramp,
}

struct Cartoon {
    // First, since the size of the next one is not a multiple of 16 bytes.
    detail: Detail,
    light: CartoonLight,
    form: Form,
    glint: Glint,
    rim: Rim,
    // Its length depends on the variant of the shader.
    ramp: Ramp,
}

@group(#{MATERIAL_BIND_GROUP}) @binding(100) var<uniform> cartoon: Cartoon;
