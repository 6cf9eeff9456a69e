#define_import_path bevy_comics::toon::light_shadow

// The shadow maps of lights, read as the engine reads them (`fetch_point_shadow`, `fetch_spot_shadow`,
// `fetch_directional_shadow`), with the slope of the shadow from the same texels. There are no derivatives:
// neighboring pixels may see other lights, or lie on other surfaces.

#ifdef SLOPED_SHADOWS
#import bevy_pbr::{
    mesh_view_bindings as view_bindings,
    mesh_view_types,
    shadows::{get_cascade_index, world_to_directional_light_local},
    shadow_sampling::{
        D3D_SAMPLE_POINT_COEFFS, D3D_SAMPLE_POINT_POSITIONS, POINT_SHADOW_SCALE,
        sample_shadow_cubemap_hardware,
    },
}
#import bevy_render::maths::orthonormalize
#import bevy_comics::toon::{
    light::sharpen,
    shadow_texels::{Filtered, slope_of_sums, texels_at, with_sample, with_texels},
    surface::Surface,
}

// A direction; 0 where there is none, as where a surface touches the light.
fn direction_of(v: vec3<f32>) -> vec3<f32> {
    return v * inverseSqrt(max(dot(v, v), 1e-20));
}

// The direction from the surface to a spot light, against its axis.
fn against_axis(id: u32) -> vec3<f32> {
    let light = &view_bindings::clustered_lights.data[id];
    let x = (*light).light_custom_data.x;
    let z = (*light).light_custom_data.y;
    let y = sqrt(max(0.0, 1.0 - x * x - z * z));
    let is_down = ((*light).flags & mesh_view_types::POINT_LIGHT_FLAGS_SPOT_LIGHT_Y_NEGATIVE) != 0u;
    return -vec3(x, select(y, -y, is_down), z);
}

// A place in the shadow map: texture coordinates, and the distance along the axis of the light. `axes`
// are those of the light.
fn place_in_map(id: u32, axes: mat3x3<f32>, at: vec3<f32>, normal: vec3<f32>) -> vec3<f32> {
    let light = &view_bindings::clustered_lights.data[id];
    let to_light = (*light).position_radius.xyz - at;
    let biased = -to_light
        + (*light).shadow_depth_bias * direction_of(to_light)
        + normal * (*light).shadow_normal_bias * dot(axes[2], to_light);
    let place = biased * axes;
    // What is beside or behind the light gets none of it.
    let distance = max(-place.z, 1e-4);
    let clip = place.xy / ((*light).spot_light_tan_angle * distance);
    return vec3(clamp(clip, vec2(-4.0), vec2(4.0)) * vec2(0.5, -0.5) + 0.5, distance);
}

// The filtered shadow at a place, from 36 texels that are read four at a time.
fn filtered_at(layer: i32, uv: vec2<f32>, depth: f32, size: vec2<f32>) -> Filtered {
    let on = texels_at(uv * size);
    var filtered: Filtered;
    for (var y = 0u; y < 3u; y++) {
        for (var x = 0u; x < 3u; x++) {
            let corner = on.corner + 2.0 * vec2(f32(x), f32(y)) - 2.0;
            let four = textureGatherCompare(
                view_bindings::directional_shadow_textures,
                view_bindings::directional_shadow_textures_comparison_sampler,
                corner / size,
                layer,
                depth,
            );
            filtered = with_texels(filtered, four, vec2(x, y), on.part);
        }
    }
    return filtered;
}

// The shadow of a spot light with a hard edge, 1 where the light arrives. `near`: of its shadow map.
fn spot_shadow(id: u32, s: Surface, near: f32) -> f32 {
    let axes = orthonormalize(against_axis(id));
    let here = place_in_map(id, axes, s.position, s.mesh_normal);
    let size = vec2<f32>(textureDimensions(view_bindings::directional_shadow_textures));
    let layer = i32(id) + view_bindings::lights.spot_light_shadowmap_offset;
    let filtered = filtered_at(layer, here.xy, near / here.z, size);
    if filtered.shadow <= 0.0 || filtered.shadow >= 1.0 {
        return filtered.shadow;
    }
    let right = place_in_map(id, axes, s.position + s.foot.position_x, s.mesh_normal);
    let down = place_in_map(id, axes, s.position + s.foot.position_y, s.mesh_normal);
    let slope = filtered.slope * size;
    let width = abs(dot(slope, right.xy - here.xy)) + abs(dot(slope, down.xy - here.xy));
    return sharpen(filtered.shadow, width);
}

// A cascade of a directional light: the filtered shadow, and how much it changes over a pixel.
fn shadow_in_cascade(id: u32, index: u32, s: Surface) -> vec2<f32> {
    let light = &view_bindings::lights.directional_lights[id];
    let cascade = &(*light).cascades[index];
    let biased = s.position
        + (*light).shadow_normal_bias * (*cascade).texel_size * s.mesh_normal
        + (*light).shadow_depth_bias * (*light).direction_to_light;
    let here = world_to_directional_light_local(id, index, vec4(biased, 1.0));
    if here.w == 0.0 {
        return vec2(1.0, 0.0);
    }
    let size = vec2<f32>(textureDimensions(view_bindings::directional_shadow_textures));
    let layer = i32((*light).depth_texture_base_index + index);
    let filtered = filtered_at(layer, here.xy, here.z, size);
    // The projection is orthographic.
    let right = ((*cascade).clip_from_world * vec4(s.foot.position_x, 0.0)).xy * vec2(0.5, -0.5);
    let down = ((*cascade).clip_from_world * vec4(s.foot.position_y, 0.0)).xy * vec2(0.5, -0.5);
    let slope = filtered.slope * size;
    return vec2(filtered.shadow, abs(dot(slope, right)) + abs(dot(slope, down)));
}

// The shadow of a directional light with a hard edge.
fn sun_shadow(id: u32, s: Surface) -> f32 {
    let light = &view_bindings::lights.directional_lights[id];
    let index = get_cascade_index(id, s.view_z);
    if index >= (*light).num_cascades {
        return 1.0;
    }
    var shadow = shadow_in_cascade(id, index, s);
    if index + 1u < (*light).num_cascades {
        let far = (*light).cascades[index].far_bound;
        let overlap = (1.0 - (*light).cascades_overlap_proportion) * far;
        if -s.view_z >= overlap {
            let next = shadow_in_cascade(id, index + 1u, s);
            shadow = mix(shadow, next, (-s.view_z - overlap) / (far - overlap));
        }
    }
    if shadow.x <= 0.0 || shadow.x >= 1.0 {
        return shadow.x;
    }
    return sharpen(shadow.x, shadow.y);
}

// The shadow of a point light with a hard edge.
fn point_shadow(id: u32, s: Surface) -> f32 {
    let light = &view_bindings::clustered_lights.data[id];
    let to_light = (*light).position_radius.xyz - s.position;
    let distances = abs(to_light);
    // Along the axis of the face of the cube.
    let distance = max(distances.x, max(distances.y, distances.z));
    let from_light = -to_light
        + (*light).shadow_normal_bias * distance * s.mesh_normal
        + (*light).shadow_depth_bias * direction_of(to_light);
    let biased = abs(from_light);
    let major = max(biased.x, max(biased.y, biased.z));
    let zw = -major * (*light).light_custom_data.xy + (*light).light_custom_data.zw;
    // Cube maps are left-handed.
    let flip = vec3(1.0, 1.0, -1.0);
    let direction = from_light * flip;
    let axes = orthonormalize(direction_of(direction));
    let scale = POINT_SHADOW_SCALE * distance;
    var sums: Filtered;
    for (var k = 0u; k < 8u; k++) {
        let at = D3D_SAMPLE_POINT_POSITIONS[k];
        let place = direction + scale * (at.x * axes[0] + at.y * axes[1]);
        let sample = sample_shadow_cubemap_hardware(place, zw.x / zw.y, id);
        sums = with_sample(sums, at, D3D_SAMPLE_POINT_COEFFS[k], sample);
    }
    if sums.shadow <= 0.0 || sums.shadow >= 1.0 {
        return clamp(sums.shadow, 0.0, 1.0);
    }
    let slope = slope_of_sums(sums) / max(scale, 1e-20);
    let across = slope.x * axes[0] + slope.y * axes[1];
    let width = abs(dot(across, s.foot.position_x * flip)) + abs(dot(across, s.foot.position_y * flip));
    return sharpen(sums.shadow, width);
}
#endif
