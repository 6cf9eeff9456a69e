#define_import_path bevy_comics::toon::lights

// Light of the engine's light sources that arrives at a surface of the toon material.

#import bevy_pbr::{mesh_view_bindings as view_bindings, mesh_view_types, shadows}
#ifdef ATMOSPHERE
#import bevy_pbr::{
    atmosphere::functions::{calculate_visible_sun_ratio, clamp_to_surface},
    lighting::sample_transmittance_lut,
}
#endif
#ifdef SLOPED_SHADOWS
#import bevy_comics::toon::light_shadow::{point_shadow, spot_shadow, sun_shadow}
#endif
#ifdef LIGHT_TEXTURES
#import bevy_comics::toon::light_textures::{
    directional_texture, point_texture, spot_texture,
}
#endif
#ifdef CONTACT_SHADOWS
#ifdef DEPTH_PREPASS
#import bevy_comics::toon::contact::contact_shadow
#endif
#endif
#import bevy_comics::toon::{
    light::{ToonLight, cone, rings, sharpen, slope_over_pixel, smooth_falloff,
        stops_over_pixel},
    rect::{Rect, mirrored, rect_light},
    surface::{Arriving, Surface, pixel_size},
}

const PI: f32 = 3.14159265;

// The shadow map of a point light or a spot light at a place, 1 where the light arrives.
fn light_shadow_at(is_spot: bool, id: u32, s: Surface, at: vec3<f32>) -> f32 {
    let place = vec4(at, 1.0);
    if is_spot {
        let near = view_bindings::clustered_lights.data[id].shadow_map_near_z;
        return shadows::fetch_spot_shadow(id, place, s.mesh_normal, near, s.pixel);
    }
    return shadows::fetch_point_shadow(id, place, s.mesh_normal, s.pixel);
}

// The same with a hard edge. Neighboring pixels may see other lights, so there are no
// derivatives: filters whose slope is not known are read for them, too.
fn light_shadow(is_spot: bool, id: u32, s: Surface) -> f32 {
#ifdef SLOPED_SHADOWS
    if is_spot {
        return spot_shadow(id, s, view_bindings::clustered_lights.data[id].shadow_map_near_z);
    }
    return point_shadow(id, s);
#else
    let shadow = light_shadow_at(is_spot, id, s, s.position);
    if shadow <= 0.0 || shadow >= 1.0 {
        return shadow;
    }
    return sharpen(shadow, slope_over_pixel(
        shadow,
        light_shadow_at(is_spot, id, s, s.position + s.foot.position_x),
        light_shadow_at(is_spot, id, s, s.position + s.foot.position_y),
    ));
#endif
}

// The shadow of a directional light at the surface with a hard edge; 1 if it has no shadow map. All
// pixels must run it: filters whose slope is not known have that of neighboring pixels.
fn directional_shadow(id: u32, s: Surface) -> f32 {
    let flags = view_bindings::lights.directional_lights[id].flags;
    let maps = flags & mesh_view_types::DIRECTIONAL_LIGHT_FLAGS_SHADOWS_ENABLED_BIT;
    var shadow = 1.0;
    if s.receives && maps != 0u {
#ifdef SLOPED_SHADOWS
        shadow = sun_shadow(id, s);
#else
        let place = vec4(s.position, 1.0);
        shadow = shadows::fetch_directional_shadow(id, place, s.mesh_normal, s.view_z, s.pixel);
#endif
    }
#ifdef SLOPED_SHADOWS
    return shadow;
#else
    return hard_shadow(shadow, fwidth(shadow));
#endif
}

// A shadow map that changes by `width` over a pixel, with a hard edge.
fn hard_shadow(shadow: f32, width: f32) -> f32 {
    return select(sharpen(shadow, width), shadow, shadow <= 0.0 || shadow >= 1.0);
}

// With the contact shadow, if `contact` is not 0.
fn with_contact(shadow: f32, s: Surface, to_light: vec3<f32>, contact: u32) -> f32 {
#ifdef CONTACT_SHADOWS
#ifdef DEPTH_PREPASS
    if s.receives && contact != 0u && shadow > 0.0 {
        return shadow * contact_shadow(s.position, to_light);
    }
#endif
#endif
    return shadow;
}

// 1, or 0 if the light is baked into the lightmap of the mesh. `flag` is that of lights that
// are not.
fn diffuse_part(flag: u32) -> f32 {
#ifdef LIGHTMAP
    return select(0.0, 1.0, flag != 0u);
#else
    return 1.0;
#endif
}

#ifdef ATMOSPHERE
// Light of the sun that the atmosphere lets through, as in the engine's
// `directional_light`.
fn through_atmosphere(position: vec3<f32>, to_light: vec3<f32>, disk: f32) -> vec3<f32> {
    let atmosphere = view_bindings::atmosphere;
    let at = (atmosphere.world_to_atmosphere * vec4(position, 1.0)).xyz;
    let place = clamp_to_surface(atmosphere, at);
    let radius = length(place);
    let height = dot(to_light, normalize(place));
    return sample_transmittance_lut(radius, height)
        * calculate_visible_sun_ratio(atmosphere, radius, height, disk);
}
#endif

// A directional light. All pixels must run it, since it may take derivatives.
fn directional_light(id: u32, s: Surface) -> Arriving {
    return directional_light_through(id, s, directional_shadow(id, s));
}

// The same, with what its shadow map leaves of it.
fn directional_light_through(id: u32, s: Surface, shadow: f32) -> Arriving {
    let light = &view_bindings::lights.directional_lights[id];
    var arriving: Arriving;
    arriving.to_light = (*light).direction_to_light.xyz;
    arriving.to_highlight = arriving.to_light;
    arriving.color = (*light).color.rgb;
    arriving.specular = 1.0;
#ifdef LIGHT_TEXTURES
    arriving.color *= directional_texture((*light).decal_index, s.position);
#endif
#ifdef ATMOSPHERE
    let disk = (*light).sun_disk_angular_size;
    arriving.color *= through_atmosphere(s.position, arriving.to_light, disk);
#endif
    arriving.smooth_color = arriving.color;
    let flags = (*light).flags;
    let contact = flags & mesh_view_types::DIRECTIONAL_LIGHT_FLAGS_CONTACT_SHADOWS_ENABLED_BIT;
    arriving.lit = with_contact(shadow, s, arriving.to_light, contact);
    arriving.diffuse = diffuse_part(
        flags & mesh_view_types::DIRECTIONAL_LIGHT_FLAGS_AFFECTS_LIGHTMAPPED_MESH_DIFFUSE_BIT,
    );
    return arriving;
}

// Fraction of a spot light that its cone lets through. `pixel`: the size of a pixel over
// the distance from the light.
fn spot_cone(id: u32, to_light: vec3<f32>, pixel: f32) -> f32 {
    let light = &view_bindings::clustered_lights.data[id];
    var axis = vec3((*light).light_custom_data.x, 0.0, (*light).light_custom_data.y);
    axis.y = sqrt(max(0.0, 1.0 - axis.x * axis.x - axis.z * axis.z));
    if ((*light).flags & mesh_view_types::POINT_LIGHT_FLAGS_SPOT_LIGHT_Y_NEGATIVE) != 0u {
        axis.y = -axis.y;
    }
    let inside = dot(-axis, to_light) * (*light).light_custom_data.z + (*light).light_custom_data.w;
    return cone(inside, pixel * (*light).light_custom_data.z);
}

// Exposed light of the brightest channel.
fn exposed(color: vec3<f32>) -> f32 {
    return max(color.r, max(color.g, color.b)) * view_bindings::view.exposure;
}

// A point light or spot light. `is_spot` is a constant where this is called, so that half of it is
// left out.
fn clustered_light(id: u32, is_spot: bool, s: Surface, settings: ToonLight) -> Arriving {
    let light = &view_bindings::clustered_lights.data[id];
    let offset = (*light).position_radius.xyz - s.position;
    let distance_squared = dot(offset, offset);
    var arriving: Arriving;
    arriving.per_distance = inverseSqrt(max(distance_squared, 1e-8));
    // Shorter than 1 where the surface touches the light.
    arriving.to_light = offset * arriving.per_distance;
    arriving.to_highlight = arriving.to_light;
    // Luminous intensity. Times the falloff, it is the illuminance of a surface
    // that faces the light.
    var color = (*light).color_inverse_square_range.rgb;
    let pixel = pixel_size(s.foot);
    let smooth_light = smooth_falloff(distance_squared, (*light).color_inverse_square_range.w);
    let width = stops_over_pixel(distance_squared, pixel);
    let flat_light = rings(settings, smooth_light, exposed(color), width);
    if is_spot {
        color *= spot_cone(id, arriving.to_light, pixel * arriving.per_distance);
    }
#ifdef LIGHT_TEXTURES
    if is_spot {
        color *= spot_texture((*light).decal_index, s.position, (*light).spot_light_tan_angle);
    } else {
        color *= point_texture((*light).decal_index, s.position);
    }
#endif
    arriving.color = color * flat_light;
    arriving.smooth_color = color * smooth_light;
    arriving.specular = 1.0;
    let flags = (*light).flags;
    var shadow = 1.0;
    if s.receives && (flags & mesh_view_types::POINT_LIGHT_FLAGS_SHADOWS_ENABLED_BIT) != 0u {
        shadow = light_shadow(is_spot, id, s);
    }
    let contact = flags & mesh_view_types::POINT_LIGHT_FLAGS_CONTACT_SHADOWS_ENABLED_BIT;
    arriving.lit = with_contact(shadow, s, arriving.to_light, contact);
    arriving.diffuse = diffuse_part(
        flags & mesh_view_types::POINT_LIGHT_FLAGS_AFFECTS_LIGHTMAPPED_MESH_DIFFUSE_BIT,
    );
    return arriving;
}

// A rectangle that shines to one side, without shadows, as the engine's.
fn rect_light_at(id: u32, s: Surface, settings: ToonLight) -> Arriving {
    let light = &view_bindings::lights.rect_lights[id];
    let at = s.position - (*light).position;
    var rect: Rect;
    rect.half_right = 0.5 * (*light).width * (*light).right;
    rect.half_up = 0.5 * (*light).height * (*light).up;
    var arriving: Arriving;
    arriving.to_light = (*light).up;
    arriving.to_highlight = (*light).up;
    arriving.lit = 1.0;
    // The engine counts this light on lightmapped meshes as well.
    arriving.diffuse = 1.0;
    let light_vector = rect_light(rect, at);
    let fraction = length(light_vector);
    if dot(cross((*light).up, (*light).right), at) <= 0.0 || fraction < 1e-9 {
        return arriving;
    }
    let distance_squared = dot(at, at);
    let factor = distance_squared / max((*light).range * (*light).range, 1e-4);
    let end = clamp(1.0 - factor * factor, 0.0, 1.0);
    // The luminance of the rectangle times pi is the illuminance right in front of it.
    let color = (*light).color.rgb * PI;
    // Near the rectangle, light changes more slowly than that of a point.
    let size = dot(rect.half_right, rect.half_right) + dot(rect.half_up, rect.half_up);
    let width = stops_over_pixel(distance_squared + size, pixel_size(s.foot));
    let smooth_light = fraction * end * end;
    let flat_light = rings(settings, smooth_light, exposed(color), width);
    arriving.color = color * flat_light;
    arriving.smooth_color = color * smooth_light;
    arriving.specular = 1.0;
    arriving.to_light = light_vector / fraction;
    let reflected = reflect(-s.to_eye, s.normal);
    let to_place = mirrored(rect, at, reflected) - at;
    arriving.per_distance = inverseSqrt(max(dot(to_place, to_place), 1e-8));
    arriving.to_highlight = to_place * arriving.per_distance;
    return arriving;
}
