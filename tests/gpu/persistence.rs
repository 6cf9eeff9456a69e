//! Lines that stay for some frames where their edges have become weak.

use bevy_comics_testkit::reference::{
    crack::{Crack, crack, jump},
    link::{Place, joined, linked},
    lives::Lives,
    resolve::Resolved,
};

use crate::{
    cracks::in_planes,
    line_quality::{show, turn},
    outlines::removed,
    pictures::{outlined, view_of},
    prelude::*,
    walls::{towards_the_sky, wall},
};

const SIZE: UVec2 = UVec2::new(101, 70);

fn persistent(persistence: u32) -> Outlines {
    Outlines {
        hold_frames: persistence,
        hysteresis: 3.0,
        hysteresis_ratio: 0.3,
        ..default()
    }
}

/// The lines of every frame of a turning model, bit by bit.
#[test]
fn persistent_lines_match_the_reference() {
    let mut small = Small::new(SIZE, Msaa::Off);
    let mut kept = 0;
    for (scene, persistence) in [(Specimen::Organic, 1), (Specimen::Organic, 4)] {
        small.restart(Msaa::Off);
        show(&mut small, scene);
        let outlines = persistent(persistence);
        let style = outlined(outlines);
        turn(&mut small, 2.6, 0.4);
        small.insert(VisibleDepthRange::default());
        small.style(&style);
        small.settle();
        let mut lives = Lives::default();
        for frame in 0..9 {
            // The first frames stand still.
            let turned = (frame as f32 - 5.0).max(0.0) * 0.012;
            turn(&mut small, 2.6, 0.4 + turned);
            small.headless.step(1);
            let found = small.cracks().expect("lines");
            let prepass = small.prepass().expect("depth");
            let map = style.depth_map.unwrap_or_default();
            let view = view_of(&mut small, &prepass, &map, found.rect);
            let resolved =
                Resolved::new(&prepass, |near| jump(&outlines) * view.jump_reference(near));
            let seen = resolved.view(&view);
            let [width, height] = SIZE.to_array().map(i64::from);
            let all: HashMap<Place, Crack> = (0..width * height)
                .flat_map(|i| [0, 1].map(|side| ([i % width, i / width], side)))
                .filter_map(|(pixel, side)| {
                    Some(((pixel, side), crack(&outlines, &seen, pixel, side, 1.0)?))
                })
                .collect();
            let grown = joined(&linked(&all, outlines.hysteresis as i32), &all);
            let found_ones = all.iter().filter(|(_, crack)| !crack.ledge);
            let weak = found_ones.map(|(place, crack)| (*place, *crack)).collect();
            let want = lives.next(&weak, &grown, persistence);
            // Until the reference has seen as many frames as lines can stay.
            if frame < 5 {
                continue;
            }
            kept += want.len() - grown.len();
            let lines = in_planes(&found, [0, 1]);
            let differ: Vec<&Place> = lines.symmetric_difference(&want).collect();
            assert!(
                differ.is_empty(),
                "{persistence}, frame {frame}: {differ:?}"
            );
        }
        println!("{}: {kept} cracks kept", scene.name());
    }
    assert!(kept > 20, "{kept}");
    assert_eq!(small.errors(), 0);
}

/// A view that stands still has the same lines with and without.
#[test]
fn still_views_do_not_change() {
    assert_unchanged(&[Specimen::Wires]);
}

#[test]
#[ignore = "long: every model"]
fn still_views_of_any_model_do_not_change() {
    assert_unchanged(&Specimen::ALL);
}

fn assert_unchanged(specimens: &[Specimen]) {
    let mut small = Small::new(UVec2::new(120, 68), Msaa::Off);
    for &specimen in specimens {
        small.restart(Msaa::Off);
        show(&mut small, specimen);
        turn(&mut small, 2.6, 1.1);
        let pictures = [0, 8].map(|persistence| {
            small.style(&ComicStyle::new().with(Outlines {
                hold_frames: persistence,
                ..default()
            }));
            // Until lines that were found by chance would be gone.
            small.headless.step(16);
            small.picture()
        });
        assert!(pictures[0] == pictures[1], "{}", specimen.name());
    }
}

/// Steps between two walls in fractions of the threshold: a certain edge, a weak one, and one
/// that is none. The response goes with the square of the step; the limit is 0.5, and weak
/// edges are those above 0.25.
const STRONG: f32 = 0.95;
const WEAK: f32 = 0.6;
const NONE: f32 = 0.3;

/// Two walls with a step between them.
struct Step {
    small: Small,
    front: Entity,
}

/// The height of a step, in units of the threshold: a fraction of 1.2 times the height of the
/// view.
fn height(step: f32) -> f32 {
    step * Silhouettes::default().threshold * 1.2 * 64.0
}

impl Step {
    fn new() -> Self {
        let mut small = towards_the_sky(UVec2::new(96, 64));
        wall(&mut small, [-60.0, -40.0], [60.0, 40.0], 200.0);
        let front = wall(&mut small, [-60.0, -40.0], [0.0, 40.0], 100.0);
        Self { small, front }
    }

    /// Draws a frame with a step, the edge at a place. Returns the width of the line.
    fn frame(&mut self, step: f32, x: f32) -> f32 {
        let height = height(step);
        let front = self.front;
        let at = Transform::from_xyz(x - 30.0, 0.0, -200.0 + height);
        self.small.world().entity_mut(front).insert(at);
        self.small.headless.step(1);
        removed(&self.small)[32 * 96..33 * 96].iter().sum()
    }

    fn style(&mut self, persistence: u32) {
        let outlines = Outlines {
            hold_frames: persistence,
            ..Outlines::SILHOUETTES
        };
        self.small.style(&ComicStyle::new().with(outlines));
    }

    /// A strong edge for some frames, after which all has settled.
    fn strong(&mut self) {
        for _ in 0..5 {
            self.frame(STRONG, 0.0);
        }
        assert!(self.frame(STRONG, 0.0) > 1.5);
    }

    /// Frames in which there is a line while the edge is like this, of 14.
    fn stays(&mut self, step: f32, speed: f32) -> usize {
        self.stays_within(14, step, speed)
    }

    fn stays_within(&mut self, frames: u32, step: f32, speed: f32) -> usize {
        let frames: Vec<f32> = (1..=frames)
            .map(|i| self.frame(step, speed * i as f32))
            .collect();
        let lines = frames.iter().take_while(|width| **width > 0.05).count();
        assert!(
            frames[lines..].iter().all(|width| *width < 0.05),
            "{frames:.2?}"
        );
        lines
    }
}

/// Truth: a line stays for as many frames as asked where its edge has become weak, and not for
/// one where it is gone; nothing else keeps it.
#[test]
fn lines_stay_for_as_many_frames_as_asked() {
    assert_stay_as_asked(&[3]);
}

#[test]
#[ignore = "long: more numbers of frames"]
fn lines_stay_for_any_number_of_frames() {
    assert_stay_as_asked(&[0, 1, 3, 8]);
}

fn assert_stay_as_asked(numbers: &[u32]) {
    let mut step = Step::new();
    for &persistence in numbers {
        let frames = persistence + 6;
        let stays = |step: &mut Step, height, speed| step.stays_within(frames, height, speed);
        step.style(persistence);
        // Until the lines of the last number are gone.
        for _ in 0..2 {
            step.frame(NONE, 0.0);
        }
        let found = stays(&mut step, WEAK, 0.0);
        assert_eq!(found, 0, "weak edges alone are no lines");
        step.strong();
        assert_eq!(stays(&mut step, WEAK, 0.0), persistence as usize);
        // Slowly moving edges too.
        step.strong();
        assert_eq!(stays(&mut step, WEAK, 0.4), persistence as usize);
        step.strong();
        assert_eq!(stays(&mut step, NONE, 0.0), 0, "a ghost");
        // What moves far is not found again.
        step.strong();
        assert_eq!(stays(&mut step, WEAK, 5.0), 0);
        // Neither after a cut, nor with other settings.
        step.strong();
        let camera = step.small.camera;
        step.small.world().trigger(CameraCut { entity: camera });
        assert_eq!(stays(&mut step, WEAK, 0.0), 0, "after a cut");
        step.strong();
        step.small.style(&ComicStyle::new().with(Outlines {
            hold_frames: persistence,
            width: 1.9,
            ..Outlines::SILHOUETTES
        }));
        assert_eq!(stays(&mut step, WEAK, 0.0), 0, "with another width");
        assert_eq!(step.small.errors(), 0);
    }
}

/// Truth: the line of an edge that hovers around its limit, three frames below it and two above,
/// blinks, unless it stays for three frames.
#[test]
fn lines_of_edges_around_their_limit_do_not_blink() {
    assert_blinks([(2, 6), (3, 0)]);
}

#[test]
#[ignore = "long: the ends of the range"]
fn lines_blink_only_without_enough_persistence() {
    assert_blinks([(0, 6), (8, 0)]);
}

fn assert_blinks(cases: [(u32, usize); 2]) {
    let mut step = Step::new();
    for (persistence, blinks) in cases {
        step.style(persistence);
        step.strong();
        let heights = (0..30).map(|frame| if frame % 5 < 3 { WEAK } else { STRONG });
        let lines: Vec<bool> = heights
            .map(|height| step.frame(height, 0.0) > 0.05)
            .collect();
        let ends = lines.windows(2).filter(|two| two[0] && !two[1]).count();
        // The first frame follows one with a line.
        let found = ends + usize::from(!lines[0]);
        assert_eq!(found, blinks, "{persistence}: {lines:?}");
    }
}

/// With motion vectors, lines are found again where things move.
#[test]
fn lines_follow_motion_vectors() {
    let mut step = Step::new();
    step.small.insert((DepthPrepass, MotionVectorPrepass));
    step.style(4);
    step.strong();
    assert_eq!(step.stays(WEAK, 5.0), 4);
    step.strong();
    assert_eq!(step.stays(WEAK, -3.3), 4);
    assert_eq!(step.small.errors(), 0);
}

/// A bar passes over weak edges that are parallel to its sides, and wakes them: they are gone as
/// soon as other lines that have become weak.
#[test]
fn passing_lines_leave_no_trails() {
    let mut step = Step::new();
    let front = step.front;
    step.small.world().despawn(front);
    for i in 0..14 {
        let x = -40.0 + 6.0 * i as f32;
        let ends = [[x, -40.0], [x + 3.0, 40.0]];
        wall(&mut step.small, ends[0], ends[1], 200.0 - height(WEAK));
    }
    let bar = wall(
        &mut step.small,
        [-6.0, -40.0],
        [0.0, 40.0],
        200.0 - height(3.0),
    );
    let mut woken = [0; 2];
    for (count, persistence) in woken.iter_mut().zip([0usize, 6]) {
        step.style(persistence as u32);
        for frame in 0..45 {
            // The left side of the bar, in pixels.
            let left = 8 + frame;
            let at = Transform::from_xyz(left as f32 - 48.0 + 3.0, 0.0, -200.0 + height(3.0));
            step.small.world().entity_mut(bar).insert(at);
            step.small.headless.step(1);
            let ink = removed(&step.small);
            let inked: Vec<usize> = (0..96).filter(|x| ink[32 * 96 + x] > 0.1).collect();
            if frame < 10 {
                continue;
            }
            let far = inked
                .iter()
                .filter(|x| **x + persistence + 3 < left)
                .count();
            assert_eq!(far, 0, "{persistence}, frame {frame}: {inked:?}");
            *count += inked.iter().filter(|x| **x + 2 < left).count();
        }
    }
    println!("inked behind the bar: {woken:?}");
    assert_eq!(woken[0], 0);
    assert!(woken[1] > 0, "nothing is woken");
    assert_eq!(step.small.errors(), 0);
}
