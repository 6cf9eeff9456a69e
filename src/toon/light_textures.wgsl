#define_import_path bevy_comics::toon::light_textures

// The pictures that lights project (`PointLightTexture`, `SpotLightTexture`,
// `DirectionalLightTexture`), read as the engine reads them.

#ifdef LIGHT_TEXTURES
#import bevy_pbr::{lighting::cubemap_uv, mesh_view_bindings as view_bindings}
#endif

// Where the picture of a spot light is read, at a place in the space of its decal: the light
// shines along -Z. `tan_angle` is that of its outer angle.
fn spot_uv(place: vec3<f32>, tan_angle: f32) -> vec2<f32> {
    return (place.xy / (place.z * tan_angle)) * vec2(-0.5, 0.5) + 0.5;
}

// Where the picture of a directional light is read, before it is repeated.
fn directional_uv(place: vec3<f32>) -> vec2<f32> {
    return place.xy * vec2(-0.5, 0.5) + 0.5;
}

// Whether a place is beside the picture.
fn is_beside(uv: vec2<f32>) -> bool {
    return any(clamp(uv, vec2(0.0), vec2(1.0)) != uv);
}

#ifdef LIGHT_TEXTURES
const NO_TEXTURE: u32 = 0xFFFFFFFFu;

fn texture_place(id: u32, position: vec3<f32>) -> vec3<f32> {
    return (view_bindings::clustered_decals.decals[id].local_from_world * vec4(position, 1.0)).xyz;
}

fn texture_at(id: u32, uv: vec2<f32>) -> f32 {
    let image = view_bindings::clustered_decals.decals[id].base_color_texture_index;
    return textureSampleLevel(
        view_bindings::clustered_decal_textures[image],
        view_bindings::clustered_decal_sampler,
        uv,
        0.0,
    ).r;
}

fn point_texture(id: u32, position: vec3<f32>) -> f32 {
    if id == NO_TEXTURE {
        return 1.0;
    }
    let order = view_bindings::clustered_decals.decals[id].tag;
    return texture_at(id, cubemap_uv(texture_place(id, position), order));
}

fn spot_texture(id: u32, position: vec3<f32>, tan_angle: f32) -> f32 {
    if id == NO_TEXTURE {
        return 1.0;
    }
    let place = texture_place(id, position);
    if place.z >= 0.0 {
        return 1.0;
    }
    return texture_at(id, spot_uv(place, tan_angle));
}

fn directional_texture(id: u32, position: vec3<f32>) -> f32 {
    if id == NO_TEXTURE {
        return 1.0;
    }
    let uv = directional_uv(texture_place(id, position));
    let tiled = view_bindings::clustered_decals.decals[id].tag != 0u;
    if !tiled && is_beside(uv) {
        return 0.0;
    }
    return texture_at(id, uv - floor(uv));
}
#endif
