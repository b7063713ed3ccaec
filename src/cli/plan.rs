//! `trackbed plan`: the solver graph, what each pass decided and what the run will take.

use super::scene::{PassArguments, SceneArguments, failed, not_yet, show};
use super::{Outcome, terminal};
use clap::ValueEnum;

/// Print the solver graph, the passes and the estimate
#[derive(clap::Args)]
#[command(after_help = "Examples:
  trackbed plan scenarios/transition.track
  trackbed plan scenarios/transition.track --format dot | dot -Tsvg -o plan.svg")]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    #[command(flatten)]
    passes: PassArguments,
    #[arg(long, value_enum, default_value = "human")]
    format: PlanFormat,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum PlanFormat {
    Human,
    Json,
    Dot,
}

pub(super) fn run(arguments: &Arguments) -> Outcome {
    let Some(compiled) = arguments.scene.compile_without(&arguments.passes) else { return Outcome::Usage };
    show(&compiled);
    let Some(graph) = compiled.graph.as_ref().filter(|_| !failed(&compiled)) else {
        return not_yet(&compiled);
    };
    let listing = graph.listing();
    match arguments.format {
        PlanFormat::Human => terminal::out(&listing.text()),
        PlanFormat::Dot => terminal::out(&listing.dot()),
        PlanFormat::Json => match serde_json::to_string_pretty(&listing) {
            Ok(json) => terminal::out(&format!("{json}\n")),
            Err(error) => {
                terminal::error(&format!("cannot write the plan as JSON: {error}"));
                return Outcome::Failed;
            }
        },
    }
    Outcome::Fine
}
