//! What acts on the track, how the answer is computed and what is kept of it: traffic, loads, laws, `solve`, `record`.

use super::Checker;
use super::geometry::Places;
use super::tier::changes;
use super::track::given;
use super::value::{Number, Record, Slot, Val};
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::response::{Place, Response};
use crate::scenario::{
    Beam, Given, Integrator, Record as Kept, Solve, StaticLoad, Target, TimeStep, Traffic, Train, Update, VolumeRecord,
};
use crate::units::{Dimension, number};

impl Checker<'_> {
    pub(super) fn traffic(&mut self, record: &Record) -> Option<Traffic> {
        let Val::Pairs(pairs) = &record.get("trains")?.value else { return None };
        let trains: Vec<Option<Train>> = pairs
            .iter()
            .map(|(train, _)| match &train.value {
                Val::Record(train) => self.train(train),
                _ => None,
            })
            .collect();
        let total = record.get("total")?;
        let span = record.get("trains")?.span;
        if pairs.len() != 1 {
            let mistake = if pairs.is_empty() {
                Diagnostic::new(Code::E0403, "traffic needs a train").at(span, "empty")
            } else {
                Diagnostic::new(Code::E0411, "this version does not mix trains yet").at(span, "several trains")
            };
            self.report(mistake);
            return None;
        }
        let share = match pairs[0].1.value {
            Val::Number(n) => n.value,
            _ => return None,
        };
        if (share - 1.0).abs() > 1e-9 {
            self.report(
                Diagnostic::new(
                    Code::E0407,
                    format!("the shares of the trains sum to {} %, not to 100 %", number(100.0 * share)),
                )
                .at(pairs[0].1.span, "of `total`")
                .help("shares are of the whole traffic: give the rest to another train, or `100 %` to this one"),
            );
            return None;
        }
        let train = trains.into_iter().next()??;
        let axles = self.axles(total, &train)?;
        Some(Traffic { train, total: Given { value: axles, origin: total.origin } })
    }

    /// Axles of a count that may be given as the mass carried: whole trains, to the nearest.
    fn axles(&mut self, slot: &Slot, train: &Train) -> Option<u64> {
        let Val::Number(n) = slot.value else { return None };
        if n.dimension == Dimension::MASS {
            let mass: f64 = train.vehicles.iter().map(|v| 2.0 * v.mass()).sum();
            let trains = (n.value / mass).round().max(1.0);
            return Some(trains as u64 * train.axles());
        }
        self.whole_axles(n.value, slot.span)
    }

    /// An axle count, which is a whole number.
    pub(super) fn whole_axles(&mut self, axles: f64, span: Span) -> Option<u64> {
        self.whole(axles, "axles", span)
    }

    pub(super) fn whole(&mut self, count: f64, what: &str, span: Span) -> Option<u64> {
        if count.fract() != 0.0 {
            self.report(
                Diagnostic::new(Code::E0405, format!("expected a whole number of {what}, found {}", number(count)))
                    .at(span, "not whole"),
            );
            return None;
        }
        Some(count as u64)
    }

    pub(super) fn loads(&mut self, record: &Record, places: &Option<Places>) -> Option<Vec<StaticLoad>> {
        let on = if record.word("on")? == "rail" { Target::Rail } else { Target::Sleepers };
        let force = record.get("force")?;
        let of = match &force.value {
            Val::Number(n) => n.basis,
            Val::Word { arguments, .. } => match arguments.get("range").map(|slot| &slot.value) {
                Some(Val::Range(smallest, _)) => smallest.basis,
                _ => return None,
            },
            _ => return None,
        };
        let (of, on_what) = (of.unwrap_or_default(), record.word("on")?);
        let allowed = if on == Target::Rail { ["rail", "track"] } else { ["seat", "sleeper"] };
        if !allowed.contains(&of) {
            let message = format!("a load on the {on_what} is `per {}` or `per {}`", allowed[0], allowed[1]);
            self.report(Diagnostic::new(Code::E0304, message).at(force.span, format!("per {of}")));
            return None;
        }
        let places = places.as_ref()?;
        let from = record.get("from").and_then(|s| Some((record.text("from")?, s.span)));
        let slot = record.get("at")?;
        let Val::List(at) = &slot.value else { return None };
        self.transition(places, from, slot.span)?;
        let loads: Vec<Option<StaticLoad>> = at
            .iter()
            .map(|slot| {
                let Val::Number(n) = slot.value else { return None };
                let x = self.chainage(places, n, from, slot.span)?;
                let x = if on == Target::Sleepers { places.seats[places.nearest_seat(x)?].0 } else { x };
                // the other forces are checked and cannot be run yet
                let force = given(record, "force").filter(|_| changes(record).is_none())?;
                Some(StaticLoad { name: record.name.clone(), on, x, force })
            })
            .collect();
        loads.into_iter().collect()
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
        let every = record.number("every").map(|n| n.value);
        let volumes = (!in_volumes.is_empty()).then(|| VolumeRecord {
            quantities: in_volumes,
            seats: seats.clone(),
            after: after.clone(),
            every,
            depth: record.number("depth").map(|n| n.value),
            volume,
            span: record.get("volume").and_then(|slot| slot.origin.span()),
        });
        let kept = (!along.is_empty()).then_some(Kept { quantities: along, seats, after, every, near: None });
        Some((kept, volumes))
    }

    /// The counts of a record: axles of traffic, or cycles of a load.
    fn counts(&mut self, record: &Record, traffic: Option<&Traffic>, cycles: Option<u64>) -> Option<Vec<u64>> {
        let slots = match record.get("after").map(|slot| &slot.value) {
            Some(Val::List(slots)) => slots.as_slice(),
            Some(_) => return None,
            None => return Some(traffic.map(|t| *t.total).or(cycles).into_iter().collect()),
        };
        let counts: Vec<Option<u64>> = match (traffic, cycles) {
            (Some(traffic), _) => slots.iter().map(|slot| self.recorded(slot, traffic)).collect(),
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

    /// A count of something that this scene does not count.
    pub(super) fn not_counted(&mut self, dimension: Dimension, counts: &str, span: Span) {
        let message = format!("this scene counts the {counts}, found {}", dimension.describe());
        self.report(Diagnostic::new(Code::E0302, message).at(span, "not counted here"));
    }

    fn recorded(&mut self, slot: &Slot, traffic: &Traffic) -> Option<u64> {
        if let Val::Number(n) = slot.value
            && n.dimension == Dimension::CYCLES
        {
            self.not_counted(n.dimension, "axles of its trains", slot.span);
            return None;
        }
        let count = self.axles_from_zero(slot, &traffic.train)?;
        if count > *traffic.total {
            self.report(
                Diagnostic::new(Code::E0602, format!("the run ends after {} axles", *traffic.total))
                    .at(slot.span, format!("{count} axles are never reached")),
            );
            return None;
        }
        let axles = traffic.train.axles();
        if !count.is_multiple_of(axles) && count != *traffic.total {
            let below = count / axles * axles;
            self.report(
                Diagnostic::new(
                    Code::E0602,
                    format!("{count} recorded axles are no whole number of trains of {axles} axles"),
                )
                .at(slot.span, "in the middle of a train")
                .help(format!("write {below} or {} axles", below + axles)),
            );
            return None;
        }
        Some(count)
    }

    fn axles_from_zero(&mut self, slot: &Slot, train: &Train) -> Option<u64> {
        match slot.value {
            Val::Number(n) if n.value == 0.0 => Some(0),
            _ => self.axles(slot, train),
        }
    }

    /// Indices of the seats that a record names; all of them where it names none.
    fn kept_seats(&mut self, record: &Record, places: &Places) -> Option<Vec<usize>> {
        let from = record.get("from").and_then(|s| Some((record.text("from")?, s.span)));
        let mut seats = Vec::new();
        let mut any = false;
        if let Some(place) = record.get("at").or(record.get("over")) {
            self.transition(places, from, place.span)?;
        }
        if let Some(Slot { value: Val::List(at), .. }) = record.get("at") {
            any = true;
            let found: Vec<Option<usize>> = at
                .iter()
                .map(|slot| match slot.value {
                    Val::Number(n) => self.seat_of(places, n, from, slot.span),
                    _ => None,
                })
                .collect();
            seats = found.into_iter().collect::<Option<_>>()?;
        }
        if let Some(Slot { value: Val::Range(a, b), span, .. }) = record.get("over") {
            any = true;
            let (from_x, to_x) = super::geometry::span(self, &Some(places.clone()), *a, *b, from, *span)?;
            seats.extend(
                (0..places.seats.len()).filter(|i| (from_x - 1e-6..=to_x + 1e-6).contains(&places.seats[*i].0)),
            );
        }
        if !any {
            seats = (0..places.seats.len()).collect();
        }
        seats.sort_unstable();
        seats.dedup();
        Some(seats)
    }

    fn seat_of(&mut self, places: &Places, at: Number, from: Option<(&str, Span)>, span: Span) -> Option<usize> {
        let x = self.chainage(places, at, from, span)?;
        places.nearest_seat(x)
    }
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
