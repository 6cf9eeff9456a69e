#define_import_path bevy_comics::effects::outlines

// Ink along the outlines that lines/ has found. The inks are the service's own
// settings, since other effects draw the same lines.

#import bevy_comics::effect::pixel::Pixel
#import bevy_comics::lines::read::{draw_lines, lines_at}

fn outlines(p: Pixel) -> Pixel {
    var out = p;
    out.color = draw_lines(p.color, lines_at(p.position));
    return out;
}
