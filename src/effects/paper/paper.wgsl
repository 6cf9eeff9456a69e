#define_import_path bevy_comics::effects::paper

// Prints the picture on paper.

#import bevy_comics::effect::noise::wave
#import bevy_comics::effect::pixel::Pixel

struct Paper {
    color: vec3<f32>,
    amount: f32,
    grain: f32,
    // Half the difference of the light on hills and in valleys.
    shading: f32,
    // Places on the sheet per physical pixel.
    scale: f32,
    seed: u32,
}

// Height of the sheet, -1 to 1, as likely below 0 as above: three octaves of value noise,
// with periods of 1.5, 4 and 12. Their grids are turned, against patterns with the grid of
// pixels.
fn paper_height(at: vec2<f32>, seed: u32) -> f32 {
    let first = 0x70617065u + 3u * seed;
    let fine = wave(vec2(0.8 * at.x - 0.6 * at.y, 0.6 * at.x + 0.8 * at.y) / 1.5, first);
    let middle = wave(vec2(5.0 * at.x - 12.0 * at.y, 12.0 * at.x + 5.0 * at.y) / (13.0 * 4.0), first + 1u);
    let coarse = wave(vec2(15.0 * at.x - 8.0 * at.y, 8.0 * at.x + 15.0 * at.y) / (17.0 * 12.0), first + 2u);
    return clamp(fine + 0.6 * middle + 0.4 * coarse, -1.0, 1.0);
}

// Linear light of a page where the sheet has a height. `page`: without the paper.
fn on_paper(s: Paper, page: vec3<f32>, height: f32) -> vec3<f32> {
    // Darkness: light above 1 has none. Ink gathers in valleys, which are shaded too. What is
    // added is 0 in the mean of all heights, and what is between 0 and 1 stays so.
    let k = clamp(1.0 - page, vec3(0.0), vec3(1.0));
    let grained = page + s.grain * height * k * (1.0 - k);
    return grained * s.color * (1.0 + s.shading * height);
}

fn paper(s: Paper, p: Pixel) -> Pixel {
    let height = paper_height(p.position * s.scale, s.seed);
    let printed = on_paper(s, p.color / max(p.alpha, 1e-3), height);
    var out = p;
    // Nothing is added where the background shows through.
    out.color = mix(p.color, printed * p.alpha, s.amount);
    return out;
}
