#define_import_path bevy_comics::lines::pass

// The uniform of the passes that find and draw lines: the only module that declares
// binding 1 of their group. WGSL requires of the structs in it that their sizes are multiples of 16 bytes.

#import bevy_comics::depth::view::View
#import bevy_comics::lines::boil::Boil
#import bevy_comics::lines::edge::{Grid, Lines}
#import bevy_comics::lines::fade::LineFade
#import bevy_comics::lines::fog::Fog
#import bevy_comics::lines::history::History
#import bevy_comics::lines::layer_lines::LineLayers
#import bevy_comics::lines::sheet::Sheet
#import bevy_comics::lines::simplification::LineSimplification
#import bevy_comics::lines::weight::Weight

struct LinePass {
    seen: View,
    settings: Lines,
    grid: Grid,
    weight: Weight,
    fog: Fog,
    fade: LineFade,
    layers: LineLayers,
    simplification: LineSimplification,
    boil: Boil,
    history: History,
    sheet: Sheet,
}

@group(0) @binding(1) var<uniform> line_pass: LinePass;
