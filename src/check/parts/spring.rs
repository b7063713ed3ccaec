//! Springs with their dampers: as written, and laid along the track.

use super::given::{agree, given};
use crate::check::evaluate::value::Record;
use crate::check::findings::Findings;
use crate::check::places::along::{Along, Laid, along, lay};
use crate::check::places::chainage::Places;
use crate::check::places::cover::Cover;
use crate::scenario::{Given, Pad};
use std::rc::Rc;

/// A spring with its damper, which may be stated as a time.
pub struct Damped {
    pub record: Rc<Record>,
    pub stiffness: Along,
    pub damping: Option<Along>,
    pub time: Option<Given>,
}

/// A [`Damped`] laid along the track.
pub struct LaidSpring<'a> {
    record: &'a Record,
    pub stiffness: Laid,
    damping: Option<Laid>,
    time: Option<Given>,
}

/// A spring from its record; `None` if it is not understood.
pub fn damped(record: &Rc<Record>) -> Option<Damped> {
    let stiffness = along(record, "stiffness")?;
    let (damping, time) = (along(record, "damping"), given(record, "damping_time"));
    if damping.is_none() && time.is_none() {
        return None;
    }
    Some(Damped { record: record.clone(), stiffness, damping, time })
}

/// Lays a spring along the track; `None` if a diagnostic has been given.
pub(super) fn lay_spring<'a>(
    spring: &'a Damped,
    places: &Places,
    part: &str,
    cover: &dyn Fn(&str) -> Cover,
    findings: &mut Findings,
) -> Option<LaidSpring<'a>> {
    let stiffness = lay(&spring.stiffness, places, &cover(&format!("{part} stiffness")), findings);
    let damping = match &spring.damping {
        Some(damping) => Some(lay(damping, places, &cover(&format!("{part} damping")), findings)?),
        None => None,
    };
    Some(LaidSpring { record: &spring.record, stiffness: stiffness?, damping, time: spring.time })
}

/// The pad at a chainage.
pub(super) fn pad_at(pad: &LaidSpring<'_>, x: f64, findings: &mut Findings) -> Option<Pad> {
    let (stiffness, damping) = spring_at(pad, x, findings)?;
    Some(Pad { stiffness, damping })
}

/// Stiffness and damping at a chainage; a damping time goes with the stiffness there.
pub fn spring_at(spring: &LaidSpring<'_>, x: f64, findings: &mut Findings) -> Option<(Given, Given)> {
    let stiffness = spring.stiffness.value_at(x);
    let by_time = spring.time.map(|time| Given { value: *time * *stiffness, origin: time.origin });
    let damping = spring.damping.as_ref().map(|damping| damping.value_at(x));
    let ways = [("damping", damping), ("damping_time * stiffness", by_time)];
    let damping = agree(spring.record, "damping", &ways, "kN s/m", findings)?;
    Some((stiffness, damping))
}

impl Damped {
    /// The value without a place; `None` if it varies.
    pub(super) fn laid_anywhere(&self) -> Option<LaidSpring<'_>> {
        let fixed = |along: &Along| match along {
            Along::Fixed(given) => Some(Laid::Fixed(*given)),
            Along::Varies(..) => None,
        };
        let damping = match &self.damping {
            Some(damping) => Some(fixed(damping)?),
            None => None,
        };
        Some(LaidSpring { record: &self.record, stiffness: fixed(&self.stiffness)?, damping, time: self.time })
    }
}
