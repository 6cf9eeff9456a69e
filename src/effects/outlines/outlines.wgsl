#define_import_path bevy_comics::effects::outlines

// Draws the outlines that the lines service has found. Their colors and opacities
// are settings of the service, since other effects draw the same lines.

#import bevy_comics::effect::pixel::Pixel
#import bevy_comics::lines::read::{draw_lines, lines_at}

fn outlines(p: Pixel) -> Pixel {
    var out = p;
    let drawn = draw_lines(vec4(p.color, p.alpha), lines_at(p.position));
    out.color = drawn.rgb;
    out.alpha = drawn.a;
    return out;
}
