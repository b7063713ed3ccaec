//! A schedule of another program: a jack is set on one place of the rail after the other.

use super::scene::{Told, planned};
use serde_json::{Value, json};
use std::ops::ControlFlow;
use trackbed::Scene;
use trackbed::execute::{
    Between, Checkpoint, Ending, Event, Executor, Listener, Machine, RunError, ScheduleState, execute,
};
use trackbed::graph::{Clock, Graph, LoadedPart, PointLoad, Schedule};
use trackbed::nodes::{NodeError, Superstructure, Unloaded};

const KIND: &str = "jack";
/// m.
const PLACES: [f64; 4] = [4.2, 4.5, 6.0, 7.7];

fn jack_at(x: f64) -> PointLoad {
    PointLoad { on: LoadedPart::Rail { x }, force: 100e3 }
}

fn run(
    machine: &Machine<'_>,
    parameters: &Value,
    listener: &mut dyn Listener,
    from: Option<Value>,
) -> Result<Ending, RunError> {
    let places: Vec<f64> = serde_json::from_value(parameters.clone()).unwrap();
    let first = from.and_then(|state| state.as_u64()).unwrap_or(0);
    for (done, x) in (1..).zip(&places).skip(first as usize) {
        // a second for each place
        let clock = Clock::Time(done as f64);
        let failed = |cause: NodeError| RunError::node(clock, cause);
        let (track, ground) = machine.track_on_ground().map_err(failed)?;
        let unloaded = track.equilibrium(&ground.settlement(), &[]).map_err(failed)?;
        let loaded = track.equilibrium(&ground.settlement(), &[jack_at(*x)]).map_err(failed)?;
        let checkpoint = || Ok(Checkpoint { clock, state: ScheduleState::Custom(json!(done)) });
        let told = [
            listener.hear(&Event::Custom { clock, what: &json!({ "jack": x }) }),
            listener.hear(&Event::Equilibrium { unloaded: &unloaded, loaded: &loaded }),
            listener.hear(&Event::Between(Between::new(true, &checkpoint))),
        ];
        if told.iter().any(ControlFlow::is_break) {
            return Ok(Ending::Stopped);
        }
    }
    Ok(Ending::Finished)
}

fn executor() -> Executor {
    Executor::default().with_schedule(KIND, Box::new(run))
}

/// The shipped check of a track at rest, and the same under the jack.
fn plans() -> (Graph, Graph) {
    let resting = Scene::open("scenarios/static_check.track").unwrap().check().graph.unwrap();
    let parameters = json!(PLACES);
    (resting.clone(), Graph { schedule: Schedule::Custom { kind: KIND.into(), parameters }, ..resting })
}

/// What a run tells of the track at rest and of the jack, and its checkpoints; it is ended after so many of them.
struct Jacked {
    states: Vec<Unloaded>,
    told: Vec<(Clock, f64)>,
    kept: Option<Checkpoint>,
    left: usize,
}

impl Jacked {
    fn until(left: usize) -> Jacked {
        Jacked { states: Vec::new(), told: Vec::new(), kept: None, left }
    }
}

impl Listener for Jacked {
    fn hear(&mut self, event: &Event<'_>) -> ControlFlow<()> {
        match event {
            Event::Equilibrium { loaded, .. } => self.states.push((*loaded).clone()),
            Event::Custom { clock, what } => self.told.push((*clock, what["jack"].as_f64().unwrap())),
            Event::Between(between) => {
                self.kept = between.checkpoint().ok();
                self.left -= 1;
                if self.left == 0 {
                    return ControlFlow::Break(());
                }
            }
            _ => {}
        }
        ControlFlow::Continue(())
    }
}

#[test]
fn it_runs_the_nodes_of_the_plan() {
    let (resting, jacked) = plans();
    let mut whole = Jacked::until(usize::MAX);
    assert_eq!(executor().run(&jacked, &mut whole, None), Ok(Ending::Finished));
    assert_eq!(whole.told, PLACES.iter().zip(1..).map(|(x, s)| (Clock::Time(f64::from(s)), *x)).collect::<Vec<_>>());
    for (x, state) in PLACES.into_iter().zip(&whole.states) {
        let alone = Graph { schedule: Schedule::Static { loads: vec![jack_at(x)] }, ..resting.clone() };
        let mut expected = Jacked::until(usize::MAX);
        execute(&alone, &mut expected).unwrap();
        assert!(expected.states == std::slice::from_ref(state), "{x} m");
    }
    assert!(jacked.listing().text().contains("schedule: a schedule `jack` of another program"));
}

#[test]
fn it_goes_on_from_its_own_checkpoint_and_from_no_other() {
    let (_, jacked) = plans();
    let [mut whole, mut begun, mut rest] = [usize::MAX, 2, usize::MAX].map(Jacked::until);
    executor().run(&jacked, &mut whole, None).unwrap();
    assert_eq!(executor().run(&jacked, &mut begun, None), Ok(Ending::Stopped));
    executor().run(&jacked, &mut rest, begun.kept.take()).unwrap();
    assert!([begun.states, rest.states].concat() == whole.states);

    let of_the_jack = Checkpoint { clock: Clock::Time(1.0), state: ScheduleState::Custom(json!(1)) };
    let (_, blocks) = planned();
    assert_eq!(executor().run(&blocks, &mut (), Some(of_the_jack)), Err(RunError::ForeignCheckpoint));
    let mut told = Told::until(1);
    executor().run(&blocks, &mut told, None).unwrap();
    assert_eq!(executor().run(&jacked, &mut (), told.checkpoint()), Err(RunError::ForeignCheckpoint));
}

#[test]
fn a_program_that_does_not_know_it_says_so() {
    let (_, jacked) = plans();
    let error = execute(&jacked, &mut ()).unwrap_err();
    assert_eq!(error, RunError::NoSchedule { kind: KIND.into() });
    assert!(error.to_string().contains("`jack`"), "{error}");
}
