//! Lamps: how their light falls off, and their shadows, against rays and the engine's own shadows.

use bevy_comics_testkit::reference::light::{edge_at, flat_falloff};

use crate::{
    prelude::*,
    ramp::set_light,
    toon::{HIGH, Kind, LOW, SIZE, Stage, blocked, ground_point_at, material, stage},
};

fn lights() -> [(&'static str, Kind); 3] {
    let to = Vec3::new(0.3, 0.0, -0.2);
    [
        ("sun", Kind::Sun(Vec3::new(-2.6, 2.4, 1.0))),
        ("lamp", Kind::Lamp(Vec3::new(-1.8, 3.0, 1.2))),
        ("spot", Kind::Spot(Vec3::new(-2.0, 3.4, 1.0), to)),
    ]
}

/// How much of a pixel of the ground the lamp reaches, from 64 rays; `None` beside the ground and
/// where `cone` says so.
fn true_cover(stage: &Stage, light: &Kind, x: u32, y: u32) -> Option<f64> {
    let mut lit = 0;
    for k in 0..64u32 {
        let sub = (Vec2::new((k % 8) as f32, (k / 8) as f32) + 0.5) / 8.0 - 0.5;
        let point = ground_point_at(stage, Vec2::new(x as f32, y as f32) + 0.5 + sub)?;
        let at = match *light {
            Kind::Sun(to) => point + to.normalize() * 50.0,
            Kind::Lamp(at) => at,
            Kind::Spot(at, to) if (to - at).angle_between(point - at) > 0.9 => return None,
            Kind::Spot(at, _) => at,
        };
        lit += u32::from(!blocked(point, at, LOW, HIGH));
    }
    Some(f64::from(lit) / 64.0)
}

/// Truth: what pixels on the border of a shadow show is how much of them the light reaches. The
/// border in the shadow map has steps of a texel, so single pixels are off; their mean is not.
#[test]
fn borders_of_shadows_cover_what_the_light_reaches() {
    let mut stage = stage(&lights()[0].1, Msaa::Off);
    for (name, light) in lights() {
        stage = stage.again(&light, Msaa::Off);
        let ids = stage.small.object_ids().expect("ids are drawn");
        let (_, picture) = stage.small.pass();
        let id = stage.small.id_of(stage.ground);
        // Ambient light alone.
        let ground = (picture.pixels.iter().zip(&ids.pixels)).filter(|(_, ids)| ids[0] == id);
        let dark = ground.map(|(pixel, _)| pixel[1]).fold(1.0, f32::min);
        let (mut count, mut off, mut sum, mut between) = (0, 0.0, 0.0, 0);
        for (x, y) in (2..SIZE.y - 2).flat_map(|y| (2..SIZE.x - 2).map(move |x| (x, y))) {
            let i = (y * SIZE.x + x) as usize;
            if ids.pixels[i][0] != id {
                continue;
            }
            let Some(cover) = true_cover(&stage, &light, x, y) else {
                continue;
            };
            if cover <= 0.0 || cover >= 1.0 {
                continue;
            }
            // The light without shadows: that of the pixels around, which changes slowly.
            let nearby = (-8..=8i32).flat_map(|dy| (-8..=8i32).map(move |dx| (dx, dy)));
            let lit = nearby
                .filter_map(|(dx, dy)| {
                    let (x, y) = (x.checked_add_signed(dx)?, y.checked_add_signed(dy)?);
                    let i = (y * SIZE.x + x) as usize;
                    let is_ground = x < SIZE.x && ids.pixels.get(i)?[0] == id;
                    is_ground.then(|| picture.pixels[i][1])
                })
                .fold(0f32, f32::max);
            let found = f64::from((picture.pixels[i][1] - dark) / (lit - dark));
            count += 1;
            between += usize::from((0.05..0.95).contains(&found));
            off += (found - cover).abs();
            sum += found - cover;
        }
        let [off, mean] = [off, sum].map(|x| x / count as f64);
        println!(
            "{name}: {count} border pixels, {between} between, off by {off:.4}, mean {mean:.4}"
        );
        // Shadow maps are moved by their biases, towards the shadow. With the slope from
        // neighboring pixels, the sun's were off by 0.24, and 0.28 of them lay between.
        let (most, moved, least, part) = match light {
            Kind::Sun(_) => (0.21, 0.18, 130, 0.45),
            Kind::Lamp(_) => (0.16, 0.1, 150, 0.5),
            Kind::Spot(..) => (0.22, 0.18, 150, 0.5),
        };
        assert!(count > least, "{count}");
        assert!(off < most && mean.abs() < moved, "{name}: {off}, {mean}");
        let found = between as f64 / count as f64;
        assert!(found > part, "{name}: {between} of {count}");
    }
}

/// Every pixel is finite on a wall in the plane of a spot light, before it and behind it; where a
/// lamp stands on the ground; and where a sun is right behind the ground, seen from the eye.
#[test]
fn lights_beside_on_and_behind_surfaces_are_finite() {
    let (from, to) = (Vec3::new(0.0, 0.7, 3.0), Vec3::new(0.0, 0.7, -5.0));
    let mut stage = stage(&Kind::Spot(from, to), Msaa::Off);
    // Other pictures have no NaN, whatever is written to them.
    stage.small.insert(Hdr);
    let wall = Plane3d::new(Vec3::Z, Vec2::splat(3.0)).mesh();
    let white = material(&mut stage.small, ToonLight::default());
    let wall = stage.small.put_shared(wall, white, Transform::IDENTITY);
    let is_finite = |stage: &mut Stage| {
        stage.small.headless.step(2);
        let (_, picture) = stage.small.pass();
        picture.pixels.iter().flatten().all(|x| x.is_finite())
    };
    for at in [0.0f32, 0.5, -0.5] {
        let place = Transform::from_xyz(0.0, 0.7, 3.0 + at);
        stage.small.world().entity_mut(wall).insert(place);
        assert!(is_finite(&mut stage), "{at}");
    }
    stage.small.world().despawn(wall);
    let point = ground_point_at(&stage, Vec2::new(40.5, 120.5)).expect("the ground");
    let lamp = PointLight {
        shadow_maps_enabled: true,
        ..default()
    };
    let world = stage.small.world();
    world.spawn((Object, lamp, Transform::from_translation(point)));
    assert!(is_finite(&mut stage), "a lamp on the ground");
    let eye = stage.small.camera_mut().get::<Transform>().copied();
    let to_eye = eye.expect("an eye").translation - point;
    let at = Transform::IDENTITY.looking_to(to_eye, Vec3::Y);
    let world = stage.small.world();
    world.spawn((Object, DirectionalLight::default(), at));
    assert!(is_finite(&mut stage), "a sun behind the ground");
}

/// Changes the intensity and the shadow maps of every light.
fn change_lights(stage: &mut Stage, change: impl Fn(&mut f32, &mut bool)) {
    let world = stage.small.world();
    for mut sun in world.query::<&mut DirectionalLight>().iter_mut(world) {
        let sun = &mut *sun;
        change(&mut sun.illuminance, &mut sun.shadow_maps_enabled);
    }
    for mut lamp in world.query::<&mut PointLight>().iter_mut(world) {
        let lamp = &mut *lamp;
        change(&mut lamp.intensity, &mut lamp.shadow_maps_enabled);
    }
    for mut lamp in world.query::<&mut SpotLight>().iter_mut(world) {
        let lamp = &mut *lamp;
        change(&mut lamp.intensity, &mut lamp.shadow_maps_enabled);
    }
}

/// Truth: light falls off with the square of the distance and ends at its range, smoothly or in
/// rings, and has the color of its lamp; the cone of a spot light ends in the middle between its
/// two angles. A ramp over the fraction of all light keeps the rings.
#[test]
fn light_of_lamps_falls_off_to_its_range() {
    const INTENSITY: f32 = 120_000.0;
    const RANGE: f32 = 4.5;
    const CONE: [f32; 2] = [0.5, 0.6];
    let white = Ramp {
        keep_intensity: 1.0,
        ..Ramp::new([RampStop::new(0.0, Color::WHITE)])
    };
    let exposure = f64::from(Exposure::default().exposure());
    let intensity = f64::from(INTENSITY) / (4.0 * std::f64::consts::PI);
    let mut stage = stage(&lights()[1].1, Msaa::Off);
    for (name, light) in lights().into_iter().skip(1) {
        stage = stage.again(&light, Msaa::Off);
        change_lights(&mut stage, |intensity, has_maps| {
            (*intensity, *has_maps) = (INTENSITY, false);
        });
        let world = stage.small.world();
        for mut lamp in world.query::<&mut PointLight>().iter_mut(world) {
            lamp.range = RANGE;
        }
        for mut lamp in world.query::<&mut SpotLight>().iter_mut(world) {
            lamp.range = RANGE;
            [lamp.inner_angle, lamp.outer_angle] = CONE;
        }
        let (at, cone) = match light {
            Kind::Spot(at, to) => (at, Some((to - at).normalize())),
            Kind::Lamp(at) | Kind::Sun(at) => (at, None),
        };
        for (falloff, ramp, tint) in [
            (0.0, None, [1.0; 3]),
            (1.0, None, [0.25, 1.0, 0.5]),
            (1.0, Some(&white), [1.0; 3]),
        ] {
            let color = Color::linear_rgb(tint[0], tint[1], tint[2]);
            let world = stage.small.world();
            for mut lamp in world.query::<&mut PointLight>().iter_mut(world) {
                lamp.color = color;
            }
            for mut lamp in world.query::<&mut SpotLight>().iter_mut(world) {
                lamp.color = color;
            }
            let light = ToonLight {
                falloff,
                ramp: ramp.cloned(),
                ..default()
            };
            set_light(&mut stage.small, &light);
            stage.small.headless.step(3);
            let ids = stage.small.object_ids().expect("ids are drawn");
            let (_, picture) = stage.small.pass();
            let id = stage.small.id_of(stage.ground);
            let wanted = |x: f32, y: f32| {
                let point = |x: f32, y: f32| ground_point_at(&stage, Vec2::new(x, y) + 0.5);
                let here = point(x, y)?;
                let beside = [point(x + 1.0, y)?, point(x, y + 1.0)?];
                let pixel: f32 = beside.iter().map(|point| here.distance(*point)).sum();
                let offset = here - at;
                let squared = f64::from(offset.length_squared());
                let per_range = f64::from(RANGE).powi(-2);
                let brightest = intensity * exposure;
                let part = flat_falloff(&light, squared, per_range, brightest, pixel.into());
                let through = cone.map_or(1.0, |axis| {
                    let [inner, outer] = CONE.map(|angle| f64::from(angle.cos()));
                    let inside = f64::from(axis.dot(offset.normalize())) - outer;
                    let width = inner - outer;
                    edge_at(
                        0.5,
                        inside / width,
                        f64::from(pixel) / squared.sqrt() / width,
                    )
                });
                let lit = through * intensity * part / std::f64::consts::PI;
                Some(exposure * (lit + 100.0))
            };
            let mut tones = BTreeSet::new();
            // Every second pixel, across and down.
            let (rows, columns) = ((1..SIZE.y - 1).step_by(2), (1..SIZE.x - 1).step_by(2));
            for (x, y) in rows.flat_map(|y| columns.clone().map(move |x| (x, y))) {
                let i = (y * SIZE.x + x) as usize;
                if ids.pixels[i][0] != id {
                    continue;
                }
                // Where the light changes, the pixel lies between its neighbors.
                let (u, v) = (x as f32, y as f32);
                let places = [
                    (u, v),
                    (u - 1.0, v),
                    (u + 1.0, v),
                    (u, v - 1.0),
                    (u, v + 1.0),
                ];
                let around: Option<Vec<f64>> = places.iter().map(|(x, y)| wanted(*x, *y)).collect();
                let Some(around) = around else {
                    continue;
                };
                let [low, high] =
                    [f64::min, f64::max].map(|of| around.iter().copied().reduce(of).expect("five"));
                let even = exposure * 100.0;
                for (found, tint) in picture.pixels[i].into_iter().zip(tint.map(f64::from)) {
                    let [low, high] = [low, high].map(|light| even + tint * (light - even));
                    // A code is up to 0.004 of linear light here.
                    assert!(
                        (low - 0.005..high + 0.005).contains(&f64::from(found)),
                        "{name}, {falloff}, {ramp:?}, ({x}, {y}): {found}, not {low} to {high}"
                    );
                }
                tones.insert(picture.pixels[i][1].to_bits());
            }
            let is_ringed = falloff > 0.0;
            assert!(
                tones.len() > 3 && (is_ringed || tones.len() > 30),
                "{}",
                tones.len()
            );
        }
    }
}

/// Draws the stage with the engine's material.
fn be_standard(stage: &mut Stage) {
    let world = stage.small.world();
    let white = StandardMaterial {
        base_color: Color::WHITE,
        perceptual_roughness: 1.0,
        reflectance: 0.0,
        ..default()
    };
    let white = world.resource_mut::<Assets<StandardMaterial>>().add(white);
    let mut objects = world.query_filtered::<Entity, With<Mesh3d>>();
    let objects: Vec<Entity> = objects.iter(world).collect();
    for object in objects {
        (world.entity_mut(object))
            .remove::<MeshMaterial3d<ToonMaterial>>()
            .insert(MeshMaterial3d(white.clone()));
    }
}

/// What is left of the light of each pixel because of shadow maps: 0 to 1. `None`: the lamp does
/// not reach it, shadows or not.
fn left_of_light(stage: &mut Stage) -> Vec<Option<f32>> {
    let mut light = |factor: f32, has_shadows: bool| {
        change_lights(stage, |intensity, has_maps| {
            *intensity *= factor;
            *has_maps = has_shadows;
        });
        stage.small.headless.step(2);
        let (_, picture) = stage.small.pass();
        let green = picture.pixels.iter().map(|pixel| pixel[1]);
        green.collect::<Vec<f32>>()
    };
    let with = light(1.0, true);
    let without = light(1.0, false);
    let none = light(0.0, false);
    let pixels = with.iter().zip(&without).zip(&none);
    let left = pixels.map(|((with, without), none)| {
        let all = without - none;
        (all > 0.02).then(|| (with - none) / all)
    });
    left.collect()
}

/// The shadow of a lamp is the engine's with a hard border: the same pixels are fully lit and fully
/// dark, and those between lie on the same side of one half.
#[test]
fn shadows_of_lamps_are_those_of_the_engine() {
    let mut stage = stage(&lights()[0].1, Msaa::Off);
    for (name, light) in lights() {
        stage = stage.again(&light, Msaa::Off);
        let ours = left_of_light(&mut stage);
        stage = stage.again(&light, Msaa::Off);
        be_standard(&mut stage);
        let theirs = left_of_light(&mut stage);
        let (mut lit, mut dark, mut between) = (0, 0, 0);
        // Pictures are of half precision.
        let near = 0.01;
        for (i, (ours, theirs)) in ours.iter().zip(&theirs).enumerate() {
            let (Some(ours), Some(theirs)) = (*ours, *theirs) else {
                continue;
            };
            let at = (i as u32 % SIZE.x, i as u32 / SIZE.x);
            if theirs > 1.0 - near / 10.0 {
                lit += 1;
                assert!(ours > 1.0 - near, "{name} {at:?}: {ours}, not lit");
            } else if theirs < near / 10.0 {
                dark += 1;
                assert!(ours < near, "{name} {at:?}: {ours}, not dark");
            } else {
                between += 1;
                let same_side = (ours - 0.5) * (theirs - 0.5) > -near;
                assert!(same_side, "{name} {at:?}: {ours}, the engine {theirs}");
            }
        }
        println!("{name}: {lit} lit, {dark} dark, {between} between");
        assert!(lit > 5000 && dark > 500 && between > 100, "{name}");
    }
}
