//! Test loads, how the answer is computed and what is kept of it: loads, laws, `solve`, `record`.

use super::Checker;
use super::geometry::Places;
use super::track::given;
use super::value::{Number, Record, Slot, Val};
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::response::{Place, Response};
use crate::scenario::{
    Beam, Force, Given, Integrator, Record as Kept, RigLoad, Solve, Target, TimeStep, Traffic, Update, VolumeRecord,
    Wave,
};
use crate::units::Dimension;

impl Checker<'_> {
    /// A load at each of its places.
    pub(super) fn loads(&mut self, record: &Record, places: &Option<Places>) -> Option<Vec<RigLoad>> {
        let on = match record.word("on")? {
            "rail" => Target::Rail,
            "bed" => Target::Bed,
            _ => Target::Sleepers,
        };
        if on == Target::Bed && !self.asked.rig {
            let message = "a plate presses on a bed of grains, and nothing of this scene asks for one";
            let help = "write `solve { substructure = full }`, with layers of grains and without trains";
            self.report(Diagnostic::new(Code::E0611, message).at(record.get("on")?.span, "no bed").help(help));
            return None;
        }
        let sided = ["confinement", "strain"].into_iter().find_map(|field| Some((field, record.get(field)?.span)));
        if let Some((field, span)) = sided.filter(|_| on != Target::Bed) {
            let message =
                format!("`{field}` is of a specimen under a plate, and this load acts on the {}", record.word("on")?);
            self.report(Diagnostic::new(Code::E0611, message).at(span, "").help("write `on = bed`, or leave it out"));
            return None;
        }
        let force = match given(record, "strain") {
            Some(strain) => Force::Strain(strain),
            None => self.force(record, on)?,
        };
        let chainages = self.chainages_at(record, "at", places.as_ref()?)?;
        let confinement = given(record, "confinement");
        let speed = given(record, "speed")?;
        let cycles = record.number("total")?.value as u64;
        let places = places.as_ref()?;
        let load = |x: f64| {
            let x = if on == Target::Sleepers { places.seats[places.nearest_seat(x)?].0 } else { x };
            Some(RigLoad { name: record.name.clone(), on, x, force: force.clone(), confinement, speed, cycles })
        };
        chainages.into_iter().map(|(x, _)| load(x)).collect()
    }

    /// The force of a load, over one rail.
    fn force(&mut self, record: &Record, on: Target) -> Option<Force> {
        let force = record.get("force")?;
        let mut history = None;
        let of = match &force.value {
            Val::Number(n) => n.basis,
            Val::Word { word, arguments } if word.name == "file" => {
                let forces = self.force_history(arguments, force.span);
                let Some(Val::Text(of)) = arguments.get("per").map(|slot| &slot.value) else {
                    if arguments.get("per").is_none() && forces.is_some() {
                        let message = "the forces of a file are `per` what?";
                        let help =
                            "write `per rail` or `per track`, or on sleepers `per seat` or `per sleeper`, behind it";
                        self.report(Diagnostic::new(Code::E0304, message).at(force.span, "").help(help));
                    }
                    return None;
                };
                history = Some(forces?);
                Some(of.as_str())
            }
            Val::Word { arguments, .. } => match arguments.get("range").map(|slot| &slot.value) {
                Some(Val::Range(smallest, _)) => smallest.basis,
                _ => return None,
            },
            _ => return None,
        };
        let (of, on_what) = (of.unwrap_or_default(), record.word("on")?);
        let allowed = if on == Target::Sleepers { ["seat", "sleeper"] } else { ["rail", "track"] };
        if !allowed.contains(&of) {
            let message = format!("a load on the {on_what} is `per {}` or `per {}`", allowed[0], allowed[1]);
            self.report(Diagnostic::new(Code::E0304, message).at(force.span, format!("per {of}")));
            return None;
        }
        match history {
            // half of what acts on the track or on a whole sleeper is over one rail
            Some(history) => {
                let share = if ["track", "sleeper"].contains(&of) { 0.5 } else { 1.0 };
                Some(Force::History(history.into_iter().map(|[time, force]| [time, share * force]).collect()))
            }
            None => acting(record),
        }
    }

    pub(super) fn solve(&mut self, record: &Record, places: &Option<Places>) -> Option<Solve> {
        let laws = record.get("law").and_then(|slot| self.laws(slot));
        let update = record.get("update_every")?;
        let exchange = match &update.value {
            Val::Number(n) => self.whole_axles(n.value, update.span).map(|axles| Update::Fixed { axles }),
            Val::Word { word, arguments } => {
                let of = |name: &str| match arguments.get(name).map(|s| (&s.value, s.span)) {
                    Some((Val::Number(n), span)) => Some((n.value, span)),
                    _ => None,
                };
                if word.name == "adaptive" {
                    self.adaptive(of("tolerance"), of("cap"))
                } else {
                    let first = of("first").and_then(|(axles, span)| self.whole_axles(axles, span));
                    first.zip(of("ratio")).map(|(first, (ratio, _))| Update::Geometric { first, ratio })
                }
            }
            _ => None,
        };
        let mut place = |name: &str| -> Option<Option<Given>> {
            let slot = record.get(name)?;
            match slot.value {
                Val::Number(n) => {
                    let places = places.as_ref()?;
                    // the passage has no `from`: its ends count from the first transition
                    let from = places.transitions.first().filter(|_| places.transitions.len() > 1);
                    let x = self.chainage(places, n, from.map(|t| (t.name.as_str(), slot.span)), slot.span)?;
                    Some(Some(Given { value: x, origin: slot.origin }))
                }
                Val::Word { .. } => Some(None),
                _ => None,
            }
        };
        let (start, finish) = (place("start"), place("finish"));
        let beam = Given {
            value: if record.word("beam")? == "timoshenko" { Beam::Timoshenko } else { Beam::Euler },
            origin: record.get("beam")?.origin,
        };
        let (integrator, time_step) = (integrator(record), time_step(record));
        let elements = record.number("elements_per_bay")?;
        let grains = self.grains(record, places);
        let (law, other_laws) = laws?;
        Some(Solve {
            law,
            other_laws,
            update: exchange?,
            update_span: update.origin.span(),
            integrator: integrator?,
            beam,
            elements_per_bay: Given { value: elements.value as u32, origin: record.get("elements_per_bay")?.origin },
            time_step: time_step?,
            start: start?,
            finish: finish?,
            gravity: given(record, "gravity")?,
            seed: record.number("seed")?.value as u64,
            grains: grains?,
        })
    }

    fn adaptive(&mut self, tolerance: Option<(f64, Span)>, cap: Option<(f64, Span)>) -> Option<Update> {
        let (tolerance, of_error) = tolerance?;
        if let Some((_, of_block)) = cap.filter(|(cap, _)| *cap < tolerance) {
            self.report(
                Diagnostic::new(Code::E0407, "a block may settle less than it may err")
                    .at(of_error, "error of a block")
                    .at(of_block, "settlement of a block")
                    .help("make `cap` larger than `tolerance`, or leave it out"),
            );
            return None;
        }
        Some(Update::Adaptive { tolerance, cap: cap.map(|(cap, _)| cap) })
    }

    /// What a record keeps of the track, and what of volumes under it.
    pub(super) fn kept(
        &mut self,
        record: &Record,
        places: &Option<Places>,
        traffic: Option<&Traffic>,
        cycles: Option<u64>,
    ) -> Option<(Option<Kept>, Option<VolumeRecord>)> {
        let Val::List(slots) = &record.get("quantities")?.value else { return None };
        let quantities: Option<Vec<(Response, Span)>> = slots
            .iter()
            .map(|slot| if let Val::Response(r) = slot.value { Some((r, slot.span)) } else { None })
            .collect();
        let seats = places.as_ref().and_then(|places| self.kept_seats(record, places));
        let after = self.counts(record, traffic, cycles);
        let volume = self.volume(record);
        let (in_volumes, along): (Vec<_>, Vec<_>) =
            quantities?.into_iter().partition(|(quantity, _)| quantity.place() == Place::Volume);
        if let Some((quantity, span)) = in_volumes.first().filter(|_| !self.asked.layers_do) {
            self.without_grains(*quantity, *span);
        }
        let names = |list: Vec<(Response, Span)>| list.into_iter().map(|(quantity, _)| quantity).collect::<Vec<_>>();
        let (in_volumes, along) = (names(in_volumes), names(along));
        let (seats, after, volume) = (seats?, after?, volume?);
        let every = given(record, "every");
        let volumes = (!in_volumes.is_empty()).then(|| VolumeRecord {
            quantities: in_volumes,
            seats: seats.clone(),
            after: after.clone(),
            every: every.map(|every| *every),
            depth: record.number("depth").map(|n| n.value),
            volume,
            span: record.get("volume").and_then(|slot| slot.origin.span()),
        });
        let states = record.word("states") == Some("vtk");
        let kept = Kept { quantities: along, seats, after, every, near: None, states };
        let kept = Some(kept).filter(|kept| states || !kept.quantities.is_empty());
        Some((kept, volumes))
    }

    /// The counts of a record: axles of traffic, or cycles of a load.
    fn counts(&mut self, record: &Record, traffic: Option<&Traffic>, cycles: Option<u64>) -> Option<Vec<u64>> {
        let slots = match record.get("after").map(|slot| &slot.value) {
            Some(Val::List(slots)) => slots.as_slice(),
            Some(_) => return None,
            None => return Some(traffic.map(|t| *t.total).or(cycles).into_iter().collect()),
        };
        // of another unit are all or none: it stands behind the list
        let cycles_of_axles = |slot: &Slot| matches!(slot.value, Val::Number(n) if n.dimension == Dimension::CYCLES);
        if let Some(first) = slots.iter().find(|slot| traffic.is_some() && cycles_of_axles(slot)) {
            self.not_counted(Dimension::CYCLES, "axles of its trains", first.span);
            return None;
        }
        let counts: Vec<Option<u64>> = match (traffic, cycles) {
            (Some(_), _) => slots.iter().map(|slot| self.between_trains(slot)).collect(),
            (None, Some(cycles)) => slots.iter().map(|slot| self.recorded_cycles(slot, cycles)).collect(),
            // what counts is not understood, or nothing does
            (None, None) => Vec::new(),
        };
        counts.into_iter().collect()
    }

    fn recorded_cycles(&mut self, slot: &Slot, cycles: u64) -> Option<u64> {
        let Val::Number(n) = slot.value else { return None };
        if n.dimension != Dimension::CYCLES {
            self.not_counted(n.dimension, "cycles of its load", slot.span);
            return None;
        }
        let count = self.whole(n.value, "cycles", slot.span)?;
        if count > cycles {
            self.report(
                Diagnostic::new(Code::E0602, format!("the run ends after {cycles} cycles"))
                    .at(slot.span, format!("{count} cycles are never reached")),
            );
            return None;
        }
        Some(count)
    }
}

/// The force of a load over one rail.
fn acting(record: &Record) -> Option<Force> {
    let Val::Word { arguments, .. } = &record.get("force")?.value else {
        return given(record, "force").map(Force::Constant);
    };
    let range = arguments.get("range")?;
    let (Val::Range(least, most), Val::Number(frequency)) = (&range.value, &arguments.get("frequency")?.value) else {
        return None;
    };
    let of_rail = |n: Number| Given { value: n.of_rail(), origin: range.origin };
    let frequency = Given { value: frequency.value, origin: arguments.get("frequency")?.origin };
    Some(Force::Cyclic { range: [of_rail(*least), of_rail(*most)], frequency, wave: Wave::Sine })
}

/// The most cycles of any load that comes back.
pub(super) fn cycles(loads: &[Record]) -> Option<u64> {
    let cyclic = loads.iter().filter(|load| matches!(load.get("force").map(|f| &f.value), Some(Val::Word { .. })));
    cyclic.filter_map(|load| load.number("total").map(|n| n.value as u64)).max()
}

/// A number among the arguments of a word.
fn argument(record: &Record, field: &str, name: &str) -> Option<Given> {
    let Val::Word { arguments, .. } = &record.get(field)?.value else { return None };
    match arguments.get(name)? {
        Slot { value: Val::Number(n), origin, .. } => Some(Given { value: n.value, origin: *origin }),
        _ => None,
    }
}

fn integrator(record: &Record) -> Option<Integrator> {
    Some(match record.word("integrator")? {
        "hht" => Integrator::Hht { alpha: *argument(record, "integrator", "alpha")? },
        "newmark" => Integrator::Newmark,
        _ => Integrator::GeneralisedAlpha { rho: *argument(record, "integrator", "rho")? },
    })
}

fn time_step(record: &Record) -> Option<TimeStep> {
    if let Some(step) = given(record, "time_step") {
        return Some(TimeStep::Fixed(step));
    }
    Some(match record.word("time_step")? {
        "adaptive" => TimeStep::Adaptive { tolerance: argument(record, "time_step", "tolerance")? },
        _ => TimeStep::Auto,
    })
}
