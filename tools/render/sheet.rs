//! A contact sheet: one scene in every preset, with its name below.

use bevy::{camera::RenderTarget, prelude::*};
use bevy_comics::{ComicStyle, style::Preset};
use image::{Rgba, RgbaImage, imageops};

use bevy_comics_testkit::{
    headless::{Headless, new_target},
    studio::set_style,
};

/// Updates until a change of style is complete.
const SETTLE: usize = 4;
const PAPER: [u8; 3] = [250, 248, 242];
const INK: [u8; 3] = [28, 26, 34];
/// Width by height of the sheet.
const ASPECT: f32 = 4.0 / 3.0;

/// Physical pixels per logical pixel for pictures of this size: widths of lines
/// are made for pictures that are 540 pixels high.
pub fn scale_factor(size: UVec2) -> f32 {
    (size.min_element() as f32 / 540.0).clamp(0.4, 1.0)
}

/// The scene without a style and in each preset, in rows.
pub fn shoot(headless: &mut Headless, camera: Entity, presets: &[Preset]) -> RgbaImage {
    let mut looks = vec![("original", ComicStyle::new())];
    looks.extend(presets.iter().map(|preset| (preset.name(), preset.style())));
    let size = headless.options.size;
    let names: Vec<&str> = looks.iter().map(|(name, _)| *name).collect();
    let labels = labels(headless, size, &names);
    let mut cells = Vec::new();
    for ((name, style), label) in looks.iter().zip(labels) {
        let world = headless.app.world_mut();
        set_style(&mut world.commands().entity(camera), style);
        world.flush();
        headless.step(SETTLE);
        cells.push((headless.picture(), label));
        println!("{name}");
    }
    arrange(&cells, size)
}

/// The presets' names as strips of the width of a cell.
fn labels(headless: &mut Headless, cell: UVec2, names: &[&str]) -> Vec<RgbaImage> {
    let strip = UVec2::new(cell.x, label_height(cell));
    let format = headless.options.format;
    let world = headless.app.world_mut();
    let target = new_target(world, strip, format);
    let camera = world
        .spawn((
            Camera2d,
            Camera {
                clear_color: Color::srgb_u8(PAPER[0], PAPER[1], PAPER[2]).into(),
                ..default()
            },
            RenderTarget::Image(target.clone().into()),
            Msaa::Off,
        ))
        .id();
    let text = world
        .spawn((
            Text::default(),
            TextFont {
                font_size: FontSize::Px(0.7 * strip.y as f32),
                ..default()
            },
            TextColor(Color::srgb_u8(INK[0], INK[1], INK[2])),
        ))
        .id();
    let row = Node {
        width: Val::Percent(100.0),
        height: Val::Percent(100.0),
        align_items: AlignItems::Center,
        justify_content: JustifyContent::Center,
        ..default()
    };
    let row = world
        .spawn((row, UiTargetCamera(camera)))
        .add_child(text)
        .id();
    let mut strips = Vec::new();
    for name in names {
        let world = headless.app.world_mut();
        world.entity_mut(text).insert(Text::new(*name));
        // Layout takes an update, glyphs another.
        headless.step(3);
        strips.push(headless.picture_of(&target));
    }
    let world = headless.app.world_mut();
    world.entity_mut(row).despawn();
    world.entity_mut(camera).despawn();
    strips
}

fn label_height(cell: UVec2) -> u32 {
    (cell.x / 11).clamp(12, 40)
}

fn gap(cell: UVec2) -> u32 {
    (cell.x / 40).max(4)
}

/// Columns of a sheet of `count` cells whose shape is about [`ASPECT`].
fn columns(count: usize, cell: UVec2) -> u32 {
    let columns = (count as f32 * ASPECT * cell.y as f32 / cell.x as f32).sqrt();
    (columns.round() as u32).clamp(1, count.max(1) as u32)
}

fn arrange(cells: &[(RgbaImage, RgbaImage)], size: UVec2) -> RgbaImage {
    let columns = columns(cells.len(), size);
    let rows = (cells.len() as u32).div_ceil(columns);
    let gap = gap(size);
    let pitch = UVec2::new(size.x + gap, size.y + label_height(size) + gap);
    let whole = pitch * UVec2::new(columns, rows) + gap;
    let [r, g, b] = PAPER;
    let mut sheet = RgbaImage::from_pixel(whole.x, whole.y, Rgba([r, g, b, 255]));
    for (index, (picture, label)) in cells.iter().enumerate() {
        let place = UVec2::new(index as u32 % columns, index as u32 / columns);
        let at = (place * pitch + gap).as_i64vec2();
        imageops::replace(&mut sheet, picture, at.x, at.y);
        imageops::replace(&mut sheet, label, at.x, at.y + i64::from(size.y));
    }
    sheet
}
