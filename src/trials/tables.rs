//! The tables of a chart and a map as CSV: one row a passage, SI units, empty if there is no value.

use super::chart::{Chart, Outcome};
use super::stability::Stability;
use super::{ExchangeMap, GrainMap};

/// One row a passage of the chart.
pub fn chart_csv(chart: &Chart) -> String {
    let mut table = Table::new(&[
        "level",
        "sweep",
        "beam",
        "integrator",
        "time_step_s",
        "tolerance",
        "elements_per_bay",
        "default",
        "efficient",
        "outcome",
        "seconds",
        "setup_s",
        "steps",
        "newton_iterations",
        "wheel_force_error",
        "wheel_force_error_rms",
        "wheel_peak_error",
        "seat_load_error",
        "contact_loss_error_s",
        "contact_loss_error",
        "rail_moment_error",
        "reason",
    ]);
    for point in &chart.points {
        let v = point.variant;
        let mut row = vec![
            point.level.name().to_owned(),
            point.sweep.name().to_owned(),
            v.beam.to_string(),
            v.method.to_string(),
            v.time_step.to_string(),
            v.tolerance.map_or(String::new(), |tolerance| tolerance.to_string()),
            v.elements_per_bay.to_string(),
            yes(point.default),
            yes(point.efficient),
        ];
        match &point.outcome {
            Outcome::Done { seconds, setup_s, steps, iterations, errors } => {
                row.extend([
                    "done".to_owned(),
                    short(*seconds),
                    short(*setup_s),
                    steps.to_string(),
                    iterations.to_string(),
                ]);
                let errors = [
                    Some(errors.wheel_force),
                    Some(errors.wheel_force_rms),
                    Some(errors.wheel_peak),
                    Some(errors.seat_load),
                    Some(errors.contact_loss_s),
                    errors.contact_loss,
                    Some(errors.rail_moment),
                ];
                row.extend(errors.map(|e| e.map_or(String::new(), short)));
                row.push(String::new());
            }
            Outcome::Unstable { seconds, reason } | Outcome::Failed { seconds, reason } => {
                let kind = if matches!(point.outcome, Outcome::Failed { .. }) { "failed" } else { "unstable" };
                row.extend([kind.to_owned(), short(*seconds)]);
                row.extend(vec![String::new(); 10]);
                row.push(reason.clone());
            }
        }
        table.row(row);
    }
    table.text()
}

/// One row a cell of the map, then one a hard scene.
pub fn stability_csv(stability: &Stability) -> String {
    let mut table = Table::new(&[
        "trial",
        "integrator",
        "time_step_s",
        "contact_factor",
        "void_m",
        "hanging_sleepers",
        "verdict",
        "error",
        "code",
        "wheel_force_over_static",
        "seats_losing_contact",
        "warnings",
        "reason",
    ]);
    for cell in &stability.map.cells {
        table.row(vec![
            "map".to_owned(),
            cell.method.to_string(),
            short(cell.time_step),
            cell.contact.to_string(),
            cell.void.depth.to_string(),
            cell.void.sleepers.map_or("all".to_owned(), |n| n.to_string()),
            cell.verdict.name().to_owned(),
            cell.verdict.error().map_or(String::new(), short),
            cell.verdict.code().unwrap_or_default().to_owned(),
            String::new(),
            String::new(),
            String::new(),
            cell.verdict.why().to_owned(),
        ]);
    }
    for stress in &stability.stresses {
        let mut row = vec![stress.name.clone()];
        row.extend(vec![String::new(); 5]);
        row.extend([
            stress.verdict.name().to_owned(),
            stress.verdict.error().map_or(String::new(), short),
            stress.verdict.code().unwrap_or_default().to_owned(),
            stress.wheel_force.map_or(String::new(), short),
            stress.losing_contact.map_or(String::new(), |n| n.to_string()),
            stress.warnings.join(" "),
            stress.verdict.why().to_owned(),
        ]);
        table.row(row);
    }
    table.text()
}

/// One row a cell of an exchange map.
pub fn exchange_csv(map: &ExchangeMap) -> String {
    let mut table = Table::new(&["axles", "block_axles", "amplification", "in_theory", "forces_stay", "forces_follow"]);
    for cell in &map.cells {
        let factors = [cell.amplification, cell.in_theory, cell.stays, cell.follows].map(short);
        table.row([cell.axles, cell.block_axles].map(|axles| axles.to_string()).into_iter().chain(factors).collect());
    }
    table.text()
}

/// One row a step at which a bed was tried.
pub fn grain_steps_csv(map: &GrainMap) -> String {
    let mut table = Table::new(&["inertia_allowed", "inertia_added", "step_over_limit", "step_s", "stopped"]);
    for trial in &map.steps {
        let values = [trial.allowed.to_string(), short(trial.added), trial.share.to_string(), short(trial.step)];
        table.row(values.into_iter().chain([trial.stopped.clone().unwrap_or_default()]).collect());
    }
    table.text()
}

/// One row a speed at which the train passed the bed.
pub fn grain_speeds_csv(map: &GrainMap) -> String {
    let mut table = Table::new(&[
        "inertia_allowed",
        "speed_m_per_s",
        "stiffness_N_per_m",
        "settled_m",
        "change_of_stiffness",
        "change_in_theory",
    ]);
    for trial in &map.speeds {
        let changes = [map.change(trial.allowed, trial.factor), map.change_in_theory(trial.allowed, trial.factor)];
        let mut row = vec![trial.allowed.to_string(), (trial.factor * map.speed).to_string()];
        row.extend([short(trial.stiffness), short(trial.settled)]);
        row.extend(changes.map(|change| change.map_or(String::new(), short)));
        table.row(row);
    }
    table.text()
}

struct Table {
    writer: csv::Writer<Vec<u8>>,
}

impl Table {
    fn new(header: &[&str]) -> Table {
        let mut table = Table { writer: csv::Writer::from_writer(Vec::new()) };
        table.row(header.iter().map(|h| (*h).to_owned()).collect());
        table
    }

    fn row(&mut self, fields: Vec<String>) {
        // into memory, rows of one length: nothing can fail
        let _ = self.writer.write_record(fields);
    }

    fn text(self) -> String {
        self.writer.into_inner().map(|bytes| String::from_utf8_lossy(&bytes).into_owned()).unwrap_or_default()
    }
}

fn yes(value: bool) -> String {
    if value { "yes" } else { "no" }.to_owned()
}

/// Four digits: what is behind them is noise of the clock or of the reference.
fn short(value: f64) -> String {
    format!("{value:.3e}")
}
