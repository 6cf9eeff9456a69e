//! The numbers of speed lines, two tones, paper, the vignette and stepped animation.

use super::*;

#[test]
fn any_number_of_the_page_is_clamped() {
    fn paper(edit: fn(&mut Paper, f32)) -> impl Fn(f32) -> Paper {
        move |x| {
            let mut value = Paper::default();
            edit(&mut value, x);
            value.sanitized()
        }
    }
    fn lines(edit: fn(&mut SpeedLines, f32)) -> impl Fn(f32) -> SpeedLines {
        move |x| {
            let mut value = SpeedLines::default();
            edit(&mut value, x);
            value.sanitized()
        }
    }
    let set = paper(|p, x| p.grain = x);
    fuzz("Paper::grain", 0.0, 1.0, |x| set(x).grain);
    let set = paper(|p, x| p.shading = x);
    fuzz("Paper::shading", 0.0, 0.3, |x| set(x).shading);
    let set = paper(|p, x| p.size = x);
    fuzz("Paper::size", 0.5, 8.0, |x| set(x).size);
    let set = paper(|p, x| p.rate = x);
    fuzz("Paper::rate", 0.0, 60.0, |x| set(x).rate);
    let set = lines(|s, x| s.center.x = x);
    fuzz("SpeedLines::center.x", -1.0, 2.0, |x| set(x).center.x);
    let set = lines(|s, x| s.center.y = x);
    fuzz("SpeedLines::center.y", -1.0, 2.0, |x| set(x).center.y);
    let set = lines(|s, x| s.angle = x);
    fuzz("SpeedLines::angle", -180.0, 180.0, |x| set(x).angle);
    let set = lines(|s, x| s.inner = x);
    fuzz("SpeedLines::inner", 0.0, 1.5, |x| set(x).inner);
    let set = lines(|s, x| s.width = x);
    fuzz("SpeedLines::width", 1.0, 40.0, |x| set(x).width);
    let set = lines(|s, x| s.dry_brush = x);
    fuzz("SpeedLines::dry_brush", 0.0, 1.0, |x| set(x).dry_brush);
    let set = lines(|s, x| s.rate = x);
    fuzz("SpeedLines::rate", 0.0, 60.0, |x| set(x).rate);
    let two_tone = |x| TwoTone {
        threshold: x,
        softness: x,
        amount: x,
        ..TwoTone::default()
    };
    let set = |x| two_tone(x).sanitized();
    fuzz("TwoTone::threshold", 0.0, 1.0, |x| set(x).threshold);
    fuzz("TwoTone::softness", 0.0, 16.0, |x| set(x).softness);
    fuzz("TwoTone::amount", 0.0, 1.0, |x| set(x).amount);
    fuzz("SteppedAnimation::rate", 1.0, 60.0, |rate| {
        SteppedAnimation { rate }.sanitized().rate
    });
}

#[test]
fn any_number_of_the_vignette_is_clamped() {
    let vignette = |edit: fn(&mut Vignette, f32)| {
        move |x| {
            let mut v = Vignette::default();
            edit(&mut v, x);
            v.sanitized()
        }
    };
    let amount = vignette(|v, x| v.amount = x);
    fuzz("Vignette::amount", 0.0, 1.0, |x| amount(x).amount);
    let radius = vignette(|v, x| v.radius = x);
    fuzz("Vignette::radius", 0.0, 1.0, |x| radius(x).radius);
    let softness = vignette(|v, x| v.softness = x);
    fuzz("Vignette::softness", 0.0, 1.0, |x| softness(x).softness);
}

#[test]
fn any_number_of_the_tone_ramp_is_clamped() {
    let ramp = |edit: fn(&mut ToneRamp, f32)| {
        move |x| {
            let mut ramp = ToneRamp::default();
            edit(&mut ramp, x);
            ramp.sanitized()
        }
    };
    let at = ramp(|r, x| r.light_at = x);
    fuzz("ToneRamp::light_at", 0.0, 1.0, |x| at(x).light_at);
    let far = ramp(|r, x| r.distant_softness = x);
    fuzz("ToneRamp::distant_softness", 0.0, 1.0, |x| {
        far(x).distant_softness
    });
    let reach = ramp(|r, x| r.reach = x);
    fuzz("ToneRamp::reach", 0.01, 1.0, |x| reach(x).reach);
}
