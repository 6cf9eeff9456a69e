//! Lines that stay for some frames where their edges have become weak.

use crate::{
    line_quality::{show, turn},
    line_scenes::silhouettes,
    outlines::removed,
    pictures::outlined,
    prelude::*,
    upscaled::override_main_pass,
    walls::{towards_the_sky, wall},
};

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
        let pictures = [0, 8].map(|hold_frames| {
            small.style(&outlined(Outlines {
                hold_frames,
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

/// No multiples of 32, by which lines are packed.
const SIZE: UVec2 = UVec2::new(98, 70);

/// Two walls with a step between them, whose edge is upright or level.
struct Step {
    small: Small,
    front: Entity,
    is_level: bool,
    /// The size of the main pass in every second frame, if it is another one.
    lower: Option<UVec2>,
    is_lower: bool,
}

/// The height of a step, in units of the threshold: a fraction of 1.2 times the height of the
/// view.
fn height(step: f32) -> f32 {
    step * Silhouettes::default().threshold * 1.2 * SIZE.y as f32
}

impl Step {
    fn new() -> Self {
        Self::with_edge(false)
    }

    fn with_edge(is_level: bool) -> Self {
        let mut small = towards_the_sky(SIZE);
        wall(&mut small, [-60.0, -60.0], [60.0, 60.0], 200.0);
        let end = if is_level { [60.0, 0.0] } else { [0.0, 60.0] };
        let front = wall(&mut small, [-60.0, -60.0], end, 100.0);
        Self {
            small,
            front,
            is_level,
            lower: None,
            is_lower: false,
        }
    }

    /// Draws a frame with an object at a place across the edge, in front of the wall. Returns the
    /// ink of all rows; of all columns, where the edge is level.
    fn draw(&mut self, object: Entity, across: f32, height: f32) -> Vec<Vec<f32>> {
        let (x, y) = if self.is_level {
            (0.0, across)
        } else {
            (across, 0.0)
        };
        let at = Transform::from_xyz(x, y, -200.0 + height);
        self.small.on(object).insert(at);
        if self.lower.is_some() {
            self.is_lower = !self.is_lower;
            override_main_pass(&mut self.small, self.lower.filter(|_| self.is_lower));
        }
        self.small.headless.step(1);
        let ink = removed(&self.small);
        let rows = ink.chunks_exact(SIZE.x as usize);
        if self.is_level {
            let column = |x| rows.clone().map(|row| row[x]).collect();
            (0..SIZE.x as usize).map(column).collect()
        } else {
            rows.map(<[f32]>::to_vec).collect()
        }
    }

    /// Draws a frame with a step, the edge at a place. Returns the width of the line. All rows have
    /// it in the same columns.
    fn frame(&mut self, step: f32, x: f32) -> f32 {
        let rows = self.draw(self.front, x - 30.0, height(step));
        // A weak edge has an eighth of the ink of a strong one.
        let inked = |row: &Vec<f32>| row.iter().map(|ink| *ink > 0.05).collect::<Vec<bool>>();
        let columns: HashSet<Vec<bool>> = rows.iter().map(inked).collect();
        assert_eq!(columns.len(), 1, "{columns:?}");
        rows[32].iter().sum()
    }

    fn style(&mut self, width: f32, hold_frames: u32) {
        self.small.style(&outlined(Outlines {
            hold_frames,
            ..silhouettes(width)
        }));
    }

    /// A strong edge for some frames, after which all has settled.
    fn strong(&mut self) {
        for _ in 0..5 {
            self.frame(STRONG, 0.0);
        }
        assert!(self.frame(STRONG, 0.0) > 1.5);
    }

    /// Frames in which there is a line while the edge is like this.
    fn stays(&mut self, frames: u32, step: f32, speed: f32) -> u32 {
        let widths = (1..=frames).map(|i| self.frame(step, speed * i as f32));
        let lines: Vec<bool> = widths.map(|width| width > 0.05).collect();
        let count = lines.iter().take_while(|line| **line).count();
        assert!(lines[count..].iter().all(|line| !line), "{lines:?}");
        count as u32
    }
}

/// Truth: a line stays for as many frames as asked where its edge has become weak, and not for
/// one where it is gone; nothing else keeps it.
#[test]
fn lines_stay_for_as_many_frames_as_asked() {
    assert_stay_as_asked(Step::new(), &[3]);
}

#[test]
fn level_lines_stay_for_as_many_frames_as_asked() {
    let mut step = Step::with_edge(true);
    step.style(2.0, 3);
    assert_found_again(&mut step, 3);
}

#[test]
#[ignore = "long: more numbers of frames, and all of it with a level edge"]
fn lines_stay_for_any_number_of_frames() {
    assert_stay_as_asked(Step::new(), &[0, 1, 3, 8]);
    assert_stay_as_asked(Step::with_edge(true), &[3]);
}

/// So many frames are judged: three more than a line stays.
fn judged(asked: u32) -> u32 {
    asked + 3
}

/// A line that rests or moves slowly stays.
fn assert_found_again(step: &mut Step, asked: u32) {
    for (what, speed) in [("resting", 0.0), ("moving slowly", 0.4)] {
        step.strong();
        assert_eq!(step.stays(judged(asked), WEAK, speed), asked, "{what}");
    }
}

fn assert_stay_as_asked(mut step: Step, numbers: &[u32]) {
    for &asked in numbers {
        let frames = judged(asked);
        step.style(2.0, asked);
        // Until the lines of the last number are gone.
        for _ in 0..2 {
            step.frame(NONE, 0.0);
        }
        let alone = step.stays(frames, WEAK, 0.0);
        assert_eq!(alone, 0, "weak edges alone are no lines");
        assert_found_again(&mut step, asked);
        for (what, height, speed) in [
            ("a ghost", NONE, 0.0),
            ("what moves far is not found again", WEAK, 5.0),
        ] {
            step.strong();
            assert_eq!(step.stays(frames, height, speed), 0, "{what}");
        }
        step.strong();
        step.small.cut();
        assert_eq!(step.stays(frames, WEAK, 0.0), 0, "after a cut");
        step.strong();
        step.style(1.9, asked);
        let other = step.stays(frames, WEAK, 0.0);
        assert_eq!(other, 0, "with another width");
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
    for (hold_frames, blinks) in cases {
        step.style(2.0, hold_frames);
        step.strong();
        let heights = (0..30).map(|frame| if frame % 5 < 3 { WEAK } else { STRONG });
        let lines = heights.map(|height| step.frame(height, 0.0) > 0.05);
        // The first frame follows one with a line.
        let lines: Vec<bool> = std::iter::once(true).chain(lines).collect();
        let ends = lines.windows(2).filter(|two| two[0] && !two[1]).count();
        assert_eq!(ends, blinks, "{hold_frames}: {lines:?}");
    }
}

/// With motion vectors, lines are found again where things move.
#[test]
fn lines_follow_motion_vectors() {
    assert_follow(false, &[5.0]);
    assert_follow(true, &[-3.3]);
}

#[test]
#[ignore = "long: more speeds; quick test hold_frames::lines_follow_motion_vectors"]
fn lines_follow_motion_vectors_whatever_their_speed() {
    for is_level in [false, true] {
        assert_follow(is_level, &[5.0, -3.3]);
    }
}

fn assert_follow(is_level: bool, speeds: &[f32]) {
    let mut step = Step::with_edge(is_level);
    step.small.insert((DepthPrepass, MotionVectorPrepass));
    step.style(2.0, 4);
    for &speed in speeds {
        step.strong();
        assert_eq!(
            step.stays(judged(4), WEAK, speed),
            4,
            "{speed}, level: {is_level}"
        );
    }
}

/// Lines stay where the resolution of the main pass changes in every frame, from either one to the
/// other, also where they move.
#[test]
fn lines_stay_while_the_resolution_changes() {
    for is_level in [false, true] {
        let mut step = Step::with_edge(is_level);
        step.lower = Some((SIZE.as_vec2() * 0.7).as_uvec2());
        step.style(2.0, 3);
        for _ in 0..2 {
            step.strong();
            assert_eq!(step.stays(judged(3), WEAK, 0.0), 3, "level: {is_level}");
            // The next weak frame has the other resolution.
            step.frame(STRONG, 0.0);
        }
        step.small.insert((DepthPrepass, MotionVectorPrepass));
        step.strong();
        let stays = step.stays(judged(3), WEAK, 5.0);
        assert_eq!(stays, 3, "moving, level: {is_level}");
    }
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
        let distance = 200.0 - height(WEAK);
        wall(&mut step.small, [x, -40.0], [x + 3.0, 40.0], distance);
    }
    let distance = 200.0 - height(3.0);
    let bar = wall(&mut step.small, [-6.0, -40.0], [0.0, 40.0], distance);
    let woken = [0usize, 6].map(|hold_frames| {
        step.style(2.0, hold_frames as u32);
        let mut woken = 0;
        for frame in 0..30 {
            // The left side of the bar, in pixels.
            let left = 8 + frame;
            let ink = &step.draw(bar, left as f32 - 49.0 + 3.0, height(3.0))[32];
            let inked = (0..98).filter(|x| ink[*x] > 0.1);
            let behind: Vec<usize> = inked.filter(|x| *x + 2 < left).collect();
            if frame >= 10 {
                let has_trail = behind.iter().any(|x| x + hold_frames + 3 < left);
                assert!(!has_trail, "{hold_frames}, frame {frame}: {behind:?}");
                woken += behind.len();
            }
        }
        woken
    });
    assert_eq!(woken[0], 0);
    assert!(woken[1] > 0, "nothing is woken");
}
