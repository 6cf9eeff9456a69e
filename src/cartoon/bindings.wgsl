#define_import_path bevy_comics::cartoon::bindings

// The uniform of the cartoon material.

#import bevy_comics::cartoon::{light::CartoonLight, ramp::Ramp}

struct Cartoon {
    light: CartoonLight,
    ramp: Ramp,
}

@group(#{MATERIAL_BIND_GROUP}) @binding(100) var<uniform> cartoon: Cartoon;
