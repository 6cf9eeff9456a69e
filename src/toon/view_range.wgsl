#define_import_path bevy_comics::toon::view_range

// The visible range of the view that is drawn, and the scale of lengths in it. They are read in the
// vertex stage, which has bindings to spare, and handed on: all vertices have the same.

#import bevy_comics::toon::visible::ViewRange
#import bevy_comics::depth::map::EMPTY
#import bevy_pbr::mesh_view_bindings::view

// A column for each view that has a range or a scale other than 1, in any order, without gaps. Rows: the
// keys of the range (see bevy_comics::depth::view); offset, floor, far plane and extent of its
// `DepthFrame`; flags, the unit of oblique views, and the scale of the projection; viewport; place, and
// the scale of lengths; axis.
@group(#{MATERIAL_BIND_GROUP}) @binding(107) var view_ranges: texture_2d<u32>;

// Whether a column is that of the view.
fn is_of_view(column: i32, viewport: vec4<u32>) -> bool {
    let scale = textureLoad(view_ranges, vec2(column, 2), 0).zw;
    let place = textureLoad(view_ranges, vec2(column, 4), 0).xyz;
    let axis = textureLoad(view_ranges, vec2(column, 5), 0).xyz;
    let own_scale = vec2(view.clip_from_view[0].x, view.clip_from_view[1].y);
    return all(viewport == bitcast<vec4<u32>>(view.viewport))
        && all(scale == bitcast<vec2<u32>>(own_scale))
        && all(place == bitcast<vec3<u32>>(view.world_position))
        && all(axis == bitcast<vec3<u32>>(view.world_from_view[2].xyz));
}

// The column of the view; -1 if it has none.
fn column_of_view() -> i32 {
    var found = -1;
    let columns = i32(textureDimensions(view_ranges).x);
    for (var column = 0; column < columns; column++) {
        let viewport = textureLoad(view_ranges, vec2(column, 3), 0);
        if viewport.z == 0u {
            break;
        }
        if is_of_view(column, viewport) {
            found = column;
            break;
        }
    }
    return found;
}

// Without one, it is empty.
fn range_of_view() -> ViewRange {
    var range: ViewRange;
    range.scale.z = f32(EMPTY);
    let column = column_of_view();
    if column >= 0 {
        let keys = textureLoad(view_ranges, vec2(column, 0), 0);
        let frame = bitcast<vec4<f32>>(textureLoad(view_ranges, vec2(column, 1), 0));
        let more = textureLoad(view_ranges, vec2(column, 2), 0);
        // Ends may be subnormal, see `depth_frame` of bevy_comics::depth::view.
        let ends = max(bitcast<vec2<f32>>(vec2(keys.x, 0u - keys.y)), vec2(1.1754944e-38));
        range.ends = vec4(ends, frame.xy);
        let flags = more.x | select(0u, EMPTY, keys.x == 0u);
        range.scale = vec4(frame.zw, f32(flags), bitcast<f32>(more.y));
    }
    return range;
}

// Pixels of the main pass per unit of the lengths of materials.
fn scale_of_view() -> f32 {
    var scale = 1.0;
    let column = column_of_view();
    if column >= 0 {
        scale = bitcast<f32>(textureLoad(view_ranges, vec2(column, 4), 0).w);
    }
    return scale;
}
