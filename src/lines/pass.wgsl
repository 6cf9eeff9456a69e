#define_import_path bevy_comics::lines::pass

// The uniform of the passes that find and draw lines: the only module that declares
// binding 1 of their group.

#import bevy_comics::depth::view::View
#import bevy_comics::lines::edge::{Grid, Lines}

struct LinePass {
    seen: View,
    settings: Lines,
    grid: Grid,
}

@group(0) @binding(1) var<uniform> line_pass: LinePass;
