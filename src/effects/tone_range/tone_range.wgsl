#define_import_path bevy_comics::effects::tone_range

// Brings the tones of the picture into a range.

#import bevy_comics::effect::pixel::Pixel
#import bevy_comics::tones::in_tone_range

fn tone_range(p: Pixel) -> Pixel {
    var out = p;
    out.color = in_tone_range(vec4(p.color, p.alpha));
    return out;
}
