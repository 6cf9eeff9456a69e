#define_import_path bevy_comics::lines::surface

// Lines in the color of surfaces. Pure functions.

#import bevy_comics::effect::color::{linear_to_oklab, luminance, oklab_to_linear}

// The ink on a surface with a color in linear light: its luminance is multiplied by one
// factor, its distance from gray by another.
fn surface_ink(color: vec3<f32>, darken: f32, saturate: f32) -> vec3<f32> {
    let gray = vec3(luminance(color));
    return darken * max(gray + saturate * (color - gray), vec3(0.0));
}

// A highlight on a surface with a color in linear light, or a shade: 1 is as light as white and has half
// of the chroma, -1 is black.
fn lightened(color: vec3<f32>, lighten: f32, saturate: f32) -> vec3<f32> {
    let lab = linear_to_oklab(max(color, vec3(0.0)));
    let lightness = mix(lab.x, select(0.0, 1.0, lighten > 0.0), abs(lighten));
    let chroma = saturate * (1.0 - 0.5 * max(lighten, 0.0)) * (1.0 + min(lighten, 0.0)) * lab.yz;
    return max(oklab_to_linear(vec3(lightness, chroma)), vec3(0.0));
}
