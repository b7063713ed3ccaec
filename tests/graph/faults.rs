//! Plans by hand that do not fit together, and what the listing of a plan shows.

use super::scene::planned;
use super::sinking::plan;
use trackbed::execute::{RunError, execute};
use trackbed::graph::quantity::WHEEL_FORCES;
use trackbed::graph::{
    Basis, Cost, CustomNode, Edge, ExpectedError, Fault, Graph, Model, Node, PassageWork, Ports, Quantity, Rate,
    Schedule, Work, faults,
};

const SUCTION: Quantity = Quantity::new("suction", "u", "Pa", Basis::Facet, Rate::Block);

fn node(name: &str, gives: &[Quantity], takes: &[Quantity]) -> Node {
    let ports = Ports { gives: gives.to_vec(), takes: takes.to_vec() };
    let (details, parameters) = (Vec::new(), serde_json::Value::Null);
    Node::new(name, Model::Custom(CustomNode { kind: "by hand".into(), ports, details, parameters }))
}

fn by_hand(nodes: Vec<Node>, edges: Vec<Edge>) -> Graph {
    let work = Work::Passages(PassageWork::default());
    Graph {
        nodes,
        edges,
        schedule: Schedule::Static { loads: Vec::new() },
        records: Vec::new(),
        supports: Vec::new(),
        decisions: Vec::new(),
        error: ExpectedError::default(),
        cost: Cost { seconds: 0.0, seconds_on_two_cores: 0.0, bytes: 0, work },
        runs: true,
    }
}

fn brings(from: &str, to: &str) -> Edge {
    Edge::new(from, to, &SUCTION)
}

/// The one fault of a plan, which nobody runs.
fn fault(graph: &Graph) -> Fault {
    let [fault] = &faults(graph)[..] else { panic!("{:?}", faults(graph)) };
    assert_eq!(execute(graph, &mut ()), Err(RunError::Faults(vec![fault.clone()])));
    fault.clone()
}

#[test]
fn a_quantity_of_another_program_is_checked_and_listed_as_any_other() {
    let whole = by_hand(
        vec![node("weather", &[SUCTION], &[]), node("slope", &[], &[SUCTION])],
        vec![brings("weather", "slope")],
    );
    assert_eq!(faults(&whole), []);
    let [edge] = &whole.listing().edges[..] else { panic!("{:?}", whole.listing().edges) };
    assert_eq!((edge.from.as_str(), edge.to.as_str(), &edge.quantity), ("weather", "slope", &SUCTION));
    assert!(whole.listing().text().contains("edge weather -> slope: suction"), "{}", whole.listing().text());
    assert!(whole.listing().dot().contains("\"weather\" -> \"slope\" [label=\"u [Pa]\"]"), "{}", whole.listing().dot());

    // beside the track of a scene it hinders nobody
    let mut graph = plan(|_| ());
    graph.nodes.extend(whole.nodes);
    graph.edges.extend(whole.edges);
    assert_eq!(faults(&graph), []);
}

#[test]
fn what_is_missing_or_doubled_is_named() {
    let slope = || node("slope", &[], &[SUCTION]);
    let weather = |name: &str| node(name, &[SUCTION], &[]);
    let missing = fault(&by_hand(vec![weather("weather"), slope()], vec![]));
    assert_eq!(missing, Fault::Missing { node: "slope".into(), quantity: SUCTION });
    assert!(missing.to_string().starts_with("node `slope` takes suction"), "{missing}");

    let (nodes, edges) =
        (vec![weather("rain"), weather("sun"), slope()], vec![brings("rain", "slope"), brings("sun", "slope")]);
    let doubled = fault(&by_hand(nodes, edges));
    let from = vec!["rain".to_owned(), "sun".to_owned()];
    assert_eq!(doubled, Fault::Doubled { node: "slope".into(), quantity: SUCTION, from });
    assert_eq!(doubled.to_string(), "node `slope` takes `suction` from one node, but rain and sun give it");

    let two = fault(&by_hand(vec![weather("rain"), weather("rain")], vec![]));
    assert_eq!(two, Fault::TwoNodes { name: "rain".into() });
}

#[test]
fn an_edge_from_or_to_nowhere_is_named() {
    let nodes = || vec![node("weather", &[SUCTION], &[]), node("slope", &[], &[SUCTION]), node("bird", &[], &[])];
    let with = |edge: Edge| fault(&by_hand(nodes(), vec![brings("weather", "slope"), edge]));
    let (unknown, given, taken) = (brings("wether", "bird"), brings("bird", "weather"), brings("weather", "bird"));
    assert_eq!(with(unknown.clone()), Fault::NoNode { edge: unknown, name: "wether".into() });
    let unknown = brings("weather", "brid");
    assert_eq!(with(unknown.clone()), Fault::NoNode { edge: unknown, name: "brid".into() });
    assert_eq!(with(given.clone()), Fault::NotGiven { edge: given });
    assert_eq!(with(taken.clone()), Fault::NotTaken { edge: taken });
}

#[test]
fn both_ends_of_an_edge_mean_the_same() {
    let other = [
        Quantity::new("suction", "u", "kPa", Basis::Facet, Rate::Block),
        Quantity::new("suction", "u", "Pa", Basis::Seat, Rate::Block),
        Quantity::new("suction", "u", "Pa", Basis::Facet, Rate::Step),
    ];
    for taken in other {
        let nodes = vec![node("weather", &[SUCTION], &[]), node("slope", &[], std::slice::from_ref(&taken))];
        let found = fault(&by_hand(nodes, vec![brings("weather", "slope")]));
        let told = found.to_string();
        assert_eq!(found, Fault::Contradictory { edge: brings("weather", "slope"), given: SUCTION, taken });
        // whoever reads it sees in what they differ
        let (given, taken) = told.split_once(", node `slope` takes ").unwrap();
        assert!(given.strip_prefix("node `weather` gives ").is_some_and(|given| given != taken), "{told}");
    }
    // a letter is for people
    let letter = Quantity::new("suction", "p_w", "Pa", Basis::Facet, Rate::Block);
    let nodes = vec![node("weather", &[SUCTION], &[]), node("slope", &[], &[letter])];
    assert_eq!(faults(&by_hand(nodes, vec![brings("weather", "slope")])), []);
}

#[test]
fn a_listing_shows_what_nodes_give() {
    let (_, mut graph) = planned();
    let listing = graph.listing();
    assert_eq!(listing.edges.len(), graph.edges.len());
    for (listed, edge) in listing.edges.iter().zip(&graph.edges) {
        let gives = graph.node(&edge.from).unwrap().ports().gives;
        assert_eq!((&listed.from, &listed.to), (&edge.from, &edge.to));
        assert!(gives.contains(&listed.quantity) && listed.quantity.name == edge.quantity, "{listed:?}");
    }
    for (listed, node) in listing.nodes.iter().zip(&graph.nodes) {
        let Ports { gives, takes } = node.ports();
        assert_eq!((&listed.gives, &listed.takes), (&gives, &takes));
    }
    // an edge that no port stands behind is a fault, and is never shown
    let invented = Edge::new("substructure", "track", &WHEEL_FORCES);
    graph.edges.push(invented.clone());
    assert_eq!(faults(&graph), [Fault::NotGiven { edge: invented }]);
    assert_eq!(graph.listing().edges.len(), listing.edges.len());
    assert_eq!(graph.listing().text(), listing.text());
}
