//! Expressions over a run's responses, as numbers: what `expect` compares and a study optimises.
//!
//! A seat's response is the one value that `sleepers.csv` holds for it (the peak of the passage where it varies in
//! time); velocities and accelerations come from histories, as do the wheels' and the rail's responses.

use super::{BlockRow, HistoryRow, MeanCycleRow, RailRow, Scalar, SleeperRow, Verdict};
use crate::graph::{Clock, SupportNode};
use crate::lower::{PLACE_TOLERANCE, absent};
use crate::scenario::response::{Expectation, Expression, Function, Measure, Place, Reduction, Response};
use crate::scenario::{Scenario, Seat, Track};
use crate::syntax::tree::{BinaryOp, Comparison};
use std::collections::{BTreeMap, HashMap};

/// The tables that an expression can read.
#[derive(Debug, Clone, Copy)]
pub struct Tables<'a> {
    pub sleepers: SleeperTable<'a>,
    pub blocks: &'a [BlockRow],
    pub rail: &'a [RailRow],
    pub histories: &'a [HistoryRow],
    pub scalars: &'a BTreeMap<String, Scalar>,
    pub track: &'a Track,
    /// The support of each of its seats; none in a rig.
    pub supports: &'a [SupportNode],
}

/// Rows of sleepers, with the columns of what was run.
#[derive(Debug, Clone, Copy)]
pub enum SleeperTable<'a> {
    /// Sleepers of a track at recorded axle counts.
    Axles(&'a [SleeperRow]),
    /// Sleepers of a test rig after each cycle, in means over its packings.
    Cycles(&'a [MeanCycleRow]),
}

/// A value of a sleeper: the count of axles or cycles, its name, its chainage, m, and the value, SI.
type Reading<'a> = (u64, &'a str, f64, f64);

impl<'a> SleeperTable<'a> {
    /// Unit of the count of its rows: axles or cycles.
    fn clock(self) -> fn(u64) -> Clock {
        match self {
            SleeperTable::Axles(_) => Clock::Axles,
            SleeperTable::Cycles(_) => Clock::Cycles,
        }
    }

    /// The column of a response, for the seats that count in extremes or for all (`everywhere`); `None` if the table
    /// has none.
    fn column(self, response: Response, everywhere: bool) -> Option<Vec<Reading<'a>>> {
        Some(match self {
            SleeperTable::Axles(rows) => {
                let column = sleeper_column(response)?;
                let rows = if everywhere { rows.iter().collect() } else { SleeperRow::that_count(rows.iter()) };
                rows.into_iter().map(|row| (row.axles, row.sleeper.as_str(), row.x_m, column(row))).collect()
            }
            SleeperTable::Cycles(rows) => {
                let column = cycle_column(response)?;
                rows.iter().map(|row| (row.cycle, row.sleeper.as_str(), row.x_m, column(row))).collect()
            }
        })
    }
}

/// Chainage and largest contact pressure of each row whose sleeper lies on a known area, m and Pa.
pub fn contact_pressures<'a>(track: &Track, rows: impl Iterator<Item = &'a SleeperRow>) -> Vec<(f64, f64)> {
    pressures_on_areas(track, rows.map(|row| (row.axles, row.sleeper.as_str(), row.x_m, row.max_contact_force_N)))
}

fn pressures_on_areas<'a>(track: &Track, forces: impl Iterator<Item = Reading<'a>>) -> Vec<(f64, f64)> {
    let area = |seat| Some((track.seat_name(seat), track.bearing_area(seat)?));
    let areas: HashMap<String, f64> = track.seats.iter().filter_map(area).collect();
    forces.filter_map(|(_, sleeper, x, force)| Some((x, force / areas.get(sleeper)?))).collect()
}

/// Chainage and largest pressure on the lowest layer under each force where the layers are known, m and Pa.
pub(super) fn subgrade_pressures<'a>(
    track: &Track,
    supports: &[SupportNode],
    forces: impl Iterator<Item = Reading<'a>>,
) -> Vec<(f64, f64)> {
    let known = |(seat, node): (&Seat, &SupportNode)| Some((track.seat_name(seat), node.onto_subgrade?));
    let by_name: HashMap<String, f64> = track.seats.iter().zip(supports).filter_map(known).collect();
    forces.filter_map(|(_, sleeper, x, force)| Some((x, force * by_name.get(sleeper)?))).collect()
}

/// The value of an expression in SI units, or why it has none. The value is finite.
pub fn evaluate(expression: &Expression, tables: Tables<'_>) -> Result<f64, String> {
    let value = match expression {
        Expression::Number(value) => *value,
        Expression::Measure(measure) => evaluate_measure(measure, tables)?,
        Expression::Negate(inner) => -evaluate(inner, tables)?,
        Expression::Function(function, of) => {
            let values: Vec<f64> = of.iter().map(|e| evaluate(e, tables)).collect::<Result<_, _>>()?;
            apply(*function, &values).ok_or("the root of a negative value")?
        }
        Expression::Binary(left, operator, right) => {
            let (left, right) = (evaluate(left, tables)?, evaluate(right, tables)?);
            if *operator == BinaryOp::Divide && right == 0.0 {
                return Err("divided by zero".to_owned());
            }
            combine(left, *operator, right)
        }
    };
    if value.is_finite() { Ok(value) } else { Err("the value is not a finite number".to_owned()) }
}

/// Every expectation of the scene against the tables.
pub fn verdicts(scenario: &Scenario, tables: Tables<'_>) -> Vec<Verdict> {
    scenario.expectations.iter().map(|expectation| verdict(expectation, tables)).collect()
}

/// A comparison against the tables.
pub fn verdict(expectation: &Expectation, tables: Tables<'_>) -> Verdict {
    let operands: Result<Vec<f64>, String> = expectation.operands.iter().map(|e| evaluate(e, tables)).collect();
    let (unit, size) = &expectation.unit;
    let (met, values, problem) = match operands {
        Ok(values) => {
            let pairs = values.windows(2).zip(&expectation.operators);
            let met = pairs.into_iter().all(|(pair, operator)| holds(pair[0], *operator, pair[1]));
            (met, values.iter().map(|value| value / size).collect(), None)
        }
        Err(problem) => (false, Vec::new(), Some(problem)),
    };
    Verdict { text: expectation.text.clone(), met, values, unit: unit.clone(), problem }
}

/// The value of an expression that asks nothing of a run.
pub fn known(expression: &Expression) -> Option<f64> {
    match expression {
        Expression::Number(value) => Some(*value),
        Expression::Measure(_) => None,
        Expression::Negate(inner) => Some(-known(inner)?),
        Expression::Function(function, of) => apply(*function, &of.iter().map(known).collect::<Option<Vec<f64>>>()?),
        Expression::Binary(left, operator, right) => {
            let (left, right) = (known(left)?, known(right)?);
            match operator {
                BinaryOp::Divide if right == 0.0 => None,
                _ => Some(combine(left, *operator, right)),
            }
        }
    }
}

/// A function of one value or more; `None` if it has no value.
fn apply(function: Function, values: &[f64]) -> Option<f64> {
    let first = *values.first()?;
    match function {
        Function::Abs => Some(first.abs()),
        Function::Sqrt => Some(first.sqrt()).filter(|root| root.is_finite()),
        Function::Min => values.iter().copied().min_by(f64::total_cmp),
        Function::Max => values.iter().copied().max_by(f64::total_cmp),
    }
}

fn combine(left: f64, operator: BinaryOp, right: f64) -> f64 {
    match operator {
        BinaryOp::Add => left + right,
        BinaryOp::Subtract => left - right,
        BinaryOp::Multiply => left * right,
        BinaryOp::Divide => left / right,
        BinaryOp::Power => left.powf(right),
    }
}

pub fn holds(left: f64, operator: Comparison, right: f64) -> bool {
    match operator {
        Comparison::Less => left < right,
        Comparison::LessOrEqual => left <= right,
        Comparison::Greater => left > right,
        Comparison::GreaterOrEqual => left >= right,
    }
}

fn evaluate_measure(measure: &Measure, tables: Tables<'_>) -> Result<f64, String> {
    let name = measure.response.name();
    if measure.response.place() == Place::Scene {
        let scalar = tables.scalars.get(name);
        return scalar.map(|s| s.value).ok_or_else(|| format!("this run has no `{name}`"));
    }
    // a peak of the whole rail is one at a node of the mesh, and may lie beyond the places of the table
    if measure.response.place() == Place::Rail
        && let Some(peak) = peak(measure, tables)
    {
        return Ok(peak);
    }
    let clock = tables.sleepers.clock();
    let values = values(measure, tables)?;
    let largest = || values.iter().copied().max_by(|a, b| a.1.total_cmp(&b.1));
    let mean = |of: fn(f64) -> f64| {
        (!values.is_empty()).then(|| values.iter().map(|v| of(v.1)).sum::<f64>() / values.len() as f64)
    };
    let result = match &measure.reduction {
        Reduction::Max => largest().map(|(_, value)| value),
        Reduction::PlaceOfMax => largest().map(|(x, _)| x),
        Reduction::Min => values.iter().map(|(_, value)| *value).min_by(f64::total_cmp),
        Reduction::Mean => mean(|value| value),
        Reduction::Rms => mean(|value| value * value).map(f64::sqrt),
        Reduction::Percentile(share) => percentile(&values, *share),
        Reduction::Misfit(measured) if values.is_empty() => {
            return Err(format!("{} to compare with {} measured values", absent(measure, clock), measured.len()));
        }
        Reduction::Misfit(measured) => return misfit(measure, values, measured),
        Reduction::Itself => return Err(format!("`{name}` has many values: write max, min or mean of `{name}`")),
    };
    result.or_else(|| peak(measure, tables)).ok_or_else(|| absent(measure, clock))
}

/// The value that a share of all values does not exceed: straight between the two nearest in order.
fn percentile(values: &[(f64, f64)], share: f64) -> Option<f64> {
    let mut sorted: Vec<f64> = values.iter().map(|v| v.1).collect();
    sorted.sort_by(f64::total_cmp);
    let place = share * (sorted.len().checked_sub(1)?) as f64;
    let (below, above) = (sorted[place.floor() as usize], sorted[place.ceil() as usize]);
    Some(below + place.fract() * (above - below))
}

/// Root mean square difference between values and measured values, at the measured places inside their range.
fn misfit(measure: &Measure, mut values: Vec<(f64, f64)>, measured: &[(f64, f64)]) -> Result<f64, String> {
    values.sort_by(|a, b| a.0.total_cmp(&b.0));
    values.dedup_by(|next, kept| (next.0 - kept.0).abs() < PLACE_TOLERANCE);
    let squares: Vec<f64> =
        measured.iter().filter_map(|(x, value)| Some((value_at(&values, *x)? - value).powi(2))).collect();
    if squares.is_empty() {
        let [first, last] = [values[0].0, values[values.len() - 1].0];
        let name = measure.response.name();
        return Err(format!("no measured place lies in the range of `{name}`, from {first} m to {last} m"));
    }
    Ok((squares.iter().sum::<f64>() / squares.len() as f64).sqrt())
}

/// The value at a place, straight between those beside it; `None` beyond them. Places ascend.
fn value_at(values: &[(f64, f64)], x: f64) -> Option<f64> {
    let [first, last] = [values.first()?, values.last()?];
    if x < first.0 - PLACE_TOLERANCE || x > last.0 + PLACE_TOLERANCE {
        return None;
    }
    let right = values.partition_point(|value| value.0 < x).min(values.len() - 1);
    let (a, b) = (values[right.saturating_sub(1)], values[right]);
    let share = if b.0 > a.0 { ((x - a.0) / (b.0 - a.0)).clamp(0.0, 1.0) } else { 0.0 };
    Some(a.1 + share * (b.1 - a.1))
}

fn peak(measure: &Measure, tables: Tables<'_>) -> Option<f64> {
    let last = tables.scalars.get("axles").map(|s| s.value as u64);
    let everywhere_at_last = measure.over.is_none() && (measure.after.is_none() || measure.after == last);
    let prefix = match measure.reduction {
        Reduction::Max => "max",
        Reduction::Min => "min",
        _ => return None,
    };
    let scalar = tables.scalars.get(&format!("{prefix}_{}", measure.response.name()));
    scalar.filter(|_| everywhere_at_last).map(|s| s.value)
}

/// Chainage and value of everything that the measure covers.
fn values(measure: &Measure, tables: Tables<'_>) -> Result<Vec<(f64, f64)>, String> {
    let inside = |x: f64| match measure.over {
        Some((a, b)) => x >= a.min(b) - PLACE_TOLERANCE && x <= a.max(b) + PLACE_TOLERANCE,
        None => true,
    };
    // near the ends of the way wheels start and stop: only a span that is named reaches there
    let everywhere = measure.over.is_some() || matches!(measure.reduction, Reduction::Misfit(_));
    if let Some(column) = tables.sleepers.column(measure.response, everywhere) {
        return Ok(covered(column, measure, inside).map(|(_, _, x, value)| (x, value)).collect());
    }
    if matches!(measure.response, Response::ContactPressure | Response::SubgradePressure) {
        let forces = tables.sleepers.column(Response::ContactForce, everywhere).unwrap_or_default();
        let forces = covered(forces, measure, inside);
        return Ok(match measure.response {
            Response::ContactPressure => pressures_on_areas(tables.track, forces),
            _ => subgrade_pressures(tables.track, tables.supports, forces),
        });
    }
    // a static check has its rail in the histories
    if let Some(column) = rail_column(measure).filter(|_| !tables.rail.is_empty()) {
        let axles = measure.after.or_else(|| tables.rail.iter().map(|row| row.axles).max());
        let rows = tables.rail.iter().filter(|row| Some(row.axles) == axles && inside(row.x_m));
        return Ok(rows.map(|row| (row.x_m, column(row))).collect());
    }
    let name = measure.response.name();
    let on_rail = measure.response.place() == Place::Rail;
    let rows = || tables.histories.iter().filter(|row| row.quantity == name && (!on_rail || row.id == "rail"));
    let axles = measure.after.or_else(|| rows().map(|row| row.axles).max());
    let rows = rows().filter(|row| Some(row.axles) == axles && inside(row.x_m));
    Ok(rows.map(|row| (row.x_m, row.value)).collect())
}

/// The readings at the count of a measure, the last one where it names none, that lie inside of its span.
fn covered<'a>(
    column: Vec<Reading<'a>>,
    measure: &Measure,
    inside: impl Fn(f64) -> bool,
) -> impl Iterator<Item = Reading<'a>> {
    let count = measure.after.or_else(|| column.iter().map(|(count, ..)| *count).max());
    column.into_iter().filter(move |(other, _, x, _)| Some(*other) == count && inside(*x))
}

/// The column of `rail.csv` that holds a response along the rail: what varies in a passage by its largest value, for a
/// minimum by its smallest.
fn rail_column(measure: &Measure) -> Option<fn(&RailRow) -> f64> {
    let least = measure.reduction == Reduction::Min;
    Some(match measure.response {
        Response::RailStiffness => |row| row.stiffness_N_per_m,
        Response::RailLevel => |row| row.level_m,
        Response::RailMoment if least => |row| row.min_moment_N_m,
        Response::RailMoment => |row| row.max_moment_N_m,
        Response::RailDisplacement if least => |row| row.min_displacement_m,
        Response::RailDisplacement => |row| row.max_displacement_m,
        _ => return None,
    })
}

/// The column of a rig's sleepers that holds a response.
fn cycle_column(response: Response) -> Option<fn(&MeanCycleRow) -> f64> {
    match response {
        Response::ContactForce => Some(|row| row.max_contact_force),
        Response::Settlement => Some(|row| row.settlement),
        Response::SleeperDisplacement => Some(|row| row.deepest),
        Response::SupportStiffness => Some(|row| row.stiffness),
        _ => None,
    }
}

/// The column of `sleepers.csv` that holds a seat's response.
fn sleeper_column(response: Response) -> Option<fn(&SleeperRow) -> f64> {
    match response {
        Response::RailSeatLoad => Some(|row| row.max_rail_seat_load_N),
        Response::ContactForce => Some(|row| row.max_contact_force_N),
        Response::GravityContactForce => Some(|row| row.gravity_contact_force_N),
        Response::Settlement => Some(|row| row.settlement_m),
        Response::Void => Some(|row| row.void_m),
        Response::SleeperDisplacement => Some(|row| row.max_sleeper_displacement_m),
        Response::SupportStiffness => Some(|row| row.support_stiffness_N_per_m),
        Response::ContactLoss => Some(|row| row.contact_loss_s),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::example;

    fn measure(reduction: Reduction, response: Response) -> Measure {
        Measure::new(reduction, response)
    }

    #[test]
    fn reductions_over_place_and_count() {
        let run = example::transition();
        let tables = Tables {
            sleepers: SleeperTable::Axles(&run.sleepers),
            blocks: &run.blocks,
            rail: &run.rail,
            histories: &run.histories,
            scalars: &run.summary.scalars,
            track: &run.scenario.track,
            supports: &[],
        };
        let value = |measure: Measure| evaluate(&Expression::Measure(measure), tables);
        let place = value(measure(Reduction::PlaceOfMax, Response::Settlement)).unwrap();
        assert!((place + 3.0).abs() < 1e-9);
        let early = Measure { after: Some(100), ..measure(Reduction::Max, Response::Settlement) };
        let late = value(measure(Reduction::Max, Response::Settlement)).unwrap();
        assert!(value(early).unwrap() < late);
        let far = Measure { over: Some((-40.0, -30.0)), ..measure(Reduction::Mean, Response::Settlement) };
        assert!((value(far).unwrap() - 1.2e-3).abs() < 1e-6);
        assert!(value(measure(Reduction::Max, Response::WheelForce)).unwrap() > 100e3);
        assert!(value(measure(Reduction::Itself, Response::DifferentialSettlement)).unwrap() > 1e-3);
        let nowhere = Measure { over: Some((100.0, 200.0)), ..measure(Reduction::Max, Response::Void) };
        assert_eq!(value(nowhere).unwrap_err(), "no value of `void` between 100 m and 200 m was recorded");
        let moment = measure(Reduction::Max, Response::RailMoment);
        assert_eq!(value(moment).unwrap(), run.summary.scalars["max_rail_moment"].value);
    }

    #[test]
    fn values_are_held_against_measured_ones() {
        let run = example::transition();
        let tables = Tables {
            sleepers: SleeperTable::Axles(&run.sleepers),
            blocks: &run.blocks,
            rail: &run.rail,
            histories: &run.histories,
            scalars: &run.summary.scalars,
            track: &run.scenario.track,
            supports: &[],
        };
        let value = |measure: Measure| evaluate(&Expression::Measure(measure), tables);
        let over =
            |reduction: Reduction| Measure { over: Some((-30.0, -20.0)), ..measure(reduction, Response::Settlement) };
        let mean = value(over(Reduction::Mean)).unwrap();
        // far from the transition all seats settle alike
        assert!((value(over(Reduction::Rms)).unwrap() / mean - 1.0).abs() < 1e-3);
        assert!((value(over(Reduction::Percentile(0.5))).unwrap() / mean - 1.0).abs() < 1e-3);
        let measured = |off: f64| Reduction::Misfit(vec![(-28.05, mean + off), (-25.0, mean - off), (-5e3, 1.0)]);
        assert!((value(over(measured(0.1e-3))).unwrap() - 0.1e-3).abs() < 1e-6);
        let nowhere = value(over(Reduction::Misfit(vec![(10.0, 0.0)]))).unwrap_err();
        assert!(nowhere.starts_with("no measured place lies in the range of `settlement`, from -3"), "{nowhere}");
        let of = |values: &[f64], share| percentile(&values.iter().map(|v| (0.0, *v)).collect::<Vec<_>>(), share);
        assert_eq!(of(&[3.0, 1.0, 2.0], 0.5), Some(2.0));
        assert_eq!((of(&[1.0, 2.0], 0.25), of(&[4.0], 0.9), of(&[], 0.5)), (Some(1.25), Some(4.0), None));
    }

    #[test]
    fn the_rail_is_known_along_its_table() {
        let run = example::transition();
        let tables = Tables {
            sleepers: SleeperTable::Axles(&run.sleepers),
            blocks: &run.blocks,
            rail: &run.rail,
            histories: &run.histories,
            scalars: &run.summary.scalars,
            track: &run.scenario.track,
            supports: &[],
        };
        let value = |measure: Measure| evaluate(&Expression::Measure(measure), tables).unwrap();
        let deepest = value(measure(Reduction::Max, Response::RailDisplacement));
        assert!((1.2e-3..1.22e-3).contains(&deepest), "{deepest}");
        assert_eq!(value(measure(Reduction::Min, Response::RailDisplacement)), -0.05e-3);
        assert_eq!(value(measure(Reduction::Min, Response::RailMoment)), -5e3);
        let near = Measure { over: Some((-5.0, 0.0)), ..measure(Reduction::Max, Response::RailMoment) };
        assert!(value(near) > 15e3);
        assert!(value(measure(Reduction::Max, Response::RailLevel)) > 1e-3);
    }

    #[test]
    fn arithmetic_and_division_by_zero() {
        let scalars = BTreeMap::new();
        let track = example::bench().scenario.track;
        let tables = Tables {
            sleepers: SleeperTable::Axles(&[]),
            blocks: &[],
            rail: &[],
            histories: &[],
            scalars: &scalars,
            track: &track,
            supports: &[],
        };
        let number = |value| Box::new(Expression::Number(value));
        let binary = |a, operator, b| evaluate(&Expression::Binary(number(a), operator, number(b)), tables);
        assert_eq!(binary(2.0, BinaryOp::Power, 3.0), Ok(8.0));
        assert_eq!(binary(2.0, BinaryOp::Divide, 0.0), Err("divided by zero".to_owned()));
        assert!(binary(-2.0, BinaryOp::Power, 0.5).is_err());
        let of = |function, values: &[f64]| {
            let values = values.iter().map(|v| Expression::Number(*v)).collect();
            evaluate(&Expression::Function(function, values), tables)
        };
        assert_eq!((of(Function::Abs, &[-2.0]), of(Function::Sqrt, &[9.0])), (Ok(2.0), Ok(3.0)));
        assert_eq!((of(Function::Min, &[2.0, 1.0]), of(Function::Max, &[2.0, 1.0])), (Ok(1.0), Ok(2.0)));
        assert_eq!(of(Function::Sqrt, &[-1.0]), Err("the root of a negative value".to_owned()));
    }
}
