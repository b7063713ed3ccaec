//! Two runs of the shipped transition zone one after the other, and both at once: what a study gains by its cores.

use std::time::Instant;
use trackbed::check::{NoModules, Override};
use trackbed::compile;
use trackbed::execute;
use trackbed::graph::Graph;
use trackbed::results::RunRecorder;
use trackbed::scenario::Scenario;

fn main() {
    let text = include_str!("../scenarios/transition.track");
    let scenes: Vec<(Scenario, Graph)> = ["40 MN/m", "80 MN/m"]
        .into_iter()
        .filter_map(|pad| {
            let set = [format!("open.pad.stiffness={pad}"), "solve.update_every=adaptive".to_owned()];
            let set: Vec<Override> = set.iter().filter_map(|text| Override::parse(text).ok()).collect();
            let compiled = compile("transition.track", text, &NoModules, &set);
            compiled.scenario.zip(compiled.graph)
        })
        .collect();
    let runs = || -> Vec<(&Graph, RunRecorder<'_>)> {
        scenes.iter().map(|(scenario, graph)| (graph, RunRecorder::new(scenario, graph))).collect()
    };

    let clock = Instant::now();
    for (graph, mut recorder) in runs() {
        if let Err(error) = execute::execute(graph, &mut recorder) {
            println!("{error}");
        }
    }
    let one_by_one = clock.elapsed().as_secs_f64();
    let clock = Instant::now();
    let failed = execute::execute_all(&mut runs()).into_iter().filter(Result::is_err).count();
    let at_once = clock.elapsed().as_secs_f64();
    println!(
        "{} runs: {one_by_one:.2} s one by one, {at_once:.2} s on {} threads, ratio {:.2}, {failed} failed",
        scenes.len(),
        rayon::current_num_threads(),
        one_by_one / at_once
    );
}
