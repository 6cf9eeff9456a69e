#define_import_path bevy_comics::lines::budget

// How much of the width of lines is left where they crowd. Pure functions.

// Columns and rows of the neighbourhood of a cell: ten columns and twelve rows more on each
// side.
const NEAR_COLUMNS: i32 = 24;
// The rows of the neighbourhood that count twice, and those that count three times.
const NEARER_ROWS: u32 = 0x00ffff00u;
const NEAREST_ROWS: u32 = 0x000ff000u;

// The cracks of a column, by how near their rows are: one bit for each of its 32 rows.
fn counted(bits: u32) -> f32 {
    return f32(countOneBits(bits) + countOneBits(bits & NEARER_ROWS) + countOneBits(bits & NEAREST_ROWS));
}

// The weight of a column: 1 at the middle of the neighbourhood, 0 at its ends.
fn column_weight(column: i32) -> f32 {
    return 1.0 - abs(f32(column) - 11.5) / 12.0;
}

// The length of lines per area, in 1 / pixels, from the sum of `counted` times
// `column_weight`. Lines of all directions have 4 / pi as many cracks as pixels of length
// (Cauchy and Crofton).
fn line_density(sum: f32) -> f32 {
    return 0.7853982 * sum / (12.0 * 56.0);
}

// The density of a single line through the middle, and one from which lines crowd.
const ALONE: f32 = 0.075;
const CROWDED: f32 = 0.15;

// The factor of a line's width: crowded lines of this width and density cover `budget` of
// the area at most. A line that is alone keeps its width.
fn budget_weight(budget: f32, density: f32, width: f32) -> f32 {
    let crowd = density * smoothstep(ALONE, CROWDED, density);
    return min(budget / max(crowd * width, 1e-6), 1.0);
}
