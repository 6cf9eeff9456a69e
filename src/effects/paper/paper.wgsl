#define_import_path bevy_comics::effects::paper

// Prints the picture on paper.

#import bevy_comics::effect::pixel::Pixel
#import bevy_comics::effect::sheet::sheet_height

struct Paper {
    color: vec3<f32>,
    amount: f32,
    grain: f32,
    // Half the difference of the light on hills and in valleys.
    shading: f32,
    // Places on the sheet per physical pixel.
    scale: f32,
    seed: u32,
    // Where the sheet begins in the render target, in physical pixels.
    corner: vec2<f32>,
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
    let height = sheet_height((p.position - s.corner) * s.scale, s.seed);
    let printed = on_paper(s, p.color / max(p.alpha, 1e-3), height);
    var out = p;
    // Nothing is added where the background shows through.
    out.color = mix(p.color, printed * p.alpha, s.amount);
    return out;
}
