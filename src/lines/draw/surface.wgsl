#define_import_path bevy_comics::lines::surface

// Lines in the colour of surfaces. Pure functions.

#import bevy_comics::effect::color::luminance

// The ink on a surface with a colour in linear light: its luminance is multiplied by one
// factor, its distance from grey by another.
fn surface_ink(color: vec3<f32>, darken: f32, saturate: f32) -> vec3<f32> {
    let grey = vec3(luminance(color));
    return darken * max(grey + saturate * (color - grey), vec3(0.0));
}
