//! The scene of a chart of runs: the scene at hand without records, expectations and studies, and shortened where its
//! reference would take too long.

use super::variants::{RunVariant, edit, is_on_grains, reference};
use crate::check::{Modules, Override};
use crate::compile::{Compiled, compile};
use crate::diag::Sources;
use crate::scenario::{Loading, Scenario, Vehicle};
use crate::syntax::parse;
use crate::syntax::tree::Item;
use crate::units::number;

/// Declarations that ask for more output and change no result.
const DROPPED: [&str; 3] = ["record", "expect", "study"];
/// Axles of a run on grains, and fewest of a run by a law.
const SHORT: u64 = 20;
/// The reference may take this share of the time for the whole chart.
pub const SHARE: f64 = 0.5;
/// Windows of a shortened run, from the soft side of a transition to its stiff side, in bays.
const WINDOWS: [[u32; 2]; 4] = [[16, 2], [12, 2], [9, 2], [5, 2]];

/// A scene as a chart runs it.
pub struct RunSubject<'a> {
    pub name: &'a str,
    pub text: String,
    pub modules: &'a (dyn Modules + Sync),
    /// Edits of the command line, then those that shorten the scene.
    pub set: Vec<Override>,
    /// What was shortened and why, as sentences.
    pub shortened: Vec<String>,
}

impl RunSubject<'_> {
    /// The scene with the edits of a variant.
    pub fn compile(&self, variant: &RunVariant) -> Compiled {
        compile(self.name, &self.text, self.modules, &[self.set.as_slice(), &variant.edits].concat())
    }

    /// Time of a variant on two cores, s; `None` if it cannot run.
    fn seconds(&self, variant: &RunVariant) -> Option<f64> {
        self.compile(variant).to_run().runnable().map(|graph| graph.cost.seconds_on_two_cores)
    }
}

/// The scene of a chart, shortened until its reference is expected to take half of `budget` (s) at most: by axles, and
/// on grains by the window. `axles` replaces the axles of the scene where it is given.
pub fn subject<'a>(
    (name, text): (&'a str, &str),
    modules: &'a (dyn Modules + Sync),
    set: &[Override],
    scenario: &Scenario,
    (axles, budget): (Option<u64>, f64),
) -> RunSubject<'a> {
    let text = without_questions(name, text);
    let mut subject = RunSubject { name, text, modules, set: set.to_vec(), shortened: Vec::new() };
    let on_grains = is_on_grains(scenario);
    let wanted = axles.or(on_grains.then_some(SHORT));
    let rules = if on_grains { windows(scenario, wanted) } else { halves(scenario, wanted) };
    // a window is shortened before a coarser tier becomes the reference
    let references: Vec<RunVariant> = reference(scenario).into_iter().filter(RunVariant::is_whole).collect();
    let fits = |subject: &RunSubject<'_>| {
        references.iter().any(|variant| subject.seconds(variant).is_some_and(|s| s <= SHARE * budget))
    };
    for (edits, sentences) in rules {
        subject.set = [set, &edits].concat();
        subject.shortened = sentences;
        if fits(&subject) {
            return subject;
        }
    }
    subject.shortened.push("as far as it goes, although its reference takes more than half of the time".to_owned());
    subject
}

/// Edits that shorten a scene, and what they do.
type Rule = (Vec<Override>, Vec<String>);

/// The whole window with these axles, then shorter windows.
fn windows(scenario: &Scenario, wanted: Option<u64>) -> Vec<Rule> {
    let whole = fewer_axles(scenario, wanted);
    let spacing = spacing(scenario);
    let shorter = WINDOWS.map(|[soft, stiff]| {
        let window = format!("-{} .. {} m", number(f64::from(soft) * spacing), number(f64::from(stiff) * spacing));
        let sentence = format!("grains from {window} around the transition");
        let (mut edits, mut sentences) = whole.clone();
        edits.push(edit("solve.window", &window));
        sentences.push(sentence);
        (edits, sentences)
    });
    std::iter::once(whole).chain(shorter).collect()
}

/// These axles, then half of them, and so on.
fn halves(scenario: &Scenario, wanted: Option<u64>) -> Vec<Rule> {
    let first = wanted.unwrap_or_else(|| axles_of(scenario));
    let halves = std::iter::successors(Some(first), |axles| (*axles > 2 * SHORT).then_some(axles / 2));
    halves.map(|axles| fewer_axles(scenario, Some(axles))).collect()
}

/// So many axles in whole trains, if the scene has more.
fn fewer_axles(scenario: &Scenario, wanted: Option<u64>) -> Rule {
    let (total, train) = (axles_of(scenario), axles_of_train(scenario));
    match wanted.map(|axles| axles.next_multiple_of(train)).filter(|axles| *axles < total) {
        Some(axles) => {
            (vec![edit("traffic.total", &format!("{axles} axles"))], vec![format!("{axles} axles instead of {total}")])
        }
        None => Rule::default(),
    }
}

fn axles_of_train(scenario: &Scenario) -> u64 {
    match &scenario.loading {
        Some(Loading::Traffic(traffic)) => (traffic.train.vehicles.len() as u64 * Vehicle::AXLES).max(1),
        _ => 1,
    }
}

fn axles_of(scenario: &Scenario) -> u64 {
    match &scenario.loading {
        Some(Loading::Traffic(traffic)) => *traffic.total,
        _ => 0,
    }
}

/// The usual distance of two seats, m.
fn spacing(scenario: &Scenario) -> f64 {
    let mut all: Vec<f64> = scenario.track.seats.windows(2).map(|pair| pair[1].x - pair[0].x).collect();
    all.sort_by(f64::total_cmp);
    all.get(all.len() / 2).copied().unwrap_or(0.6)
}

/// The text with blanks in place of the declarations that only ask for output: other lines keep their numbers.
fn without_questions(name: &str, text: &str) -> String {
    let file = Sources::default().add(name, text, false);
    let mut bytes = text.as_bytes().to_vec();
    for item in parse(file, text).0.items {
        let Item::Declaration(declaration) = item else { continue };
        if DROPPED.contains(&declaration.kind.text.as_str()) {
            let blank = bytes[declaration.span.start as usize..declaration.span.end as usize].iter_mut();
            blank.filter(|byte| **byte != b'\n').for_each(|byte| *byte = b' ');
        }
    }
    // whole declarations are replaced, so the rest is text as before
    String::from_utf8(bytes).unwrap_or_else(|_| text.to_owned())
}
