//! The map from the parameters of the plan back to their places in the text of the scene.

use crate::diag::Span;
use crate::scenario::{Loading, Scenario};
use std::collections::BTreeMap;

/// A parameter of a graph that may be written in the scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Parameter {
    /// The stiffness of the support under the seat with this index.
    Support(usize),
    /// The length of the section with this index.
    Section(usize),
    /// The speed of a kind of train, and the wheel mass and wheel-rail contact of its first vehicle.
    Speed(usize),
    WheelMass(usize),
    Contact(usize),
    /// The bogie distance of the first vehicle of a kind of train.
    Bogies(usize),
    TimeStep,
    Gravity,
    ElementsPerBay,
    /// Chainage of the leading wheel at the start and at the end of a passage.
    Start,
    Finish,
    Update,
    Total,
    Budget,
    Memory,
}

/// The places of the text from which parameters come. A parameter that is not written in the scene has no place.
#[derive(Debug, Clone, Default)]
pub struct Origins(BTreeMap<Parameter, Span>);

impl Origins {
    /// The places of a scene.
    pub(super) fn new(scenario: &Scenario) -> Origins {
        let mut origins = Origins::default();
        let mut put = |parameter, span: Option<Span>| {
            if let Some(span) = span {
                origins.0.insert(parameter, span);
            }
        };
        for (index, seat) in scenario.track.seats.iter().enumerate() {
            put(Parameter::Support(index), seat.support().and_then(|support| support.stiffness.origin.span()));
        }
        for (index, section) in scenario.track.sections.iter().enumerate() {
            put(Parameter::Section(index), section.length_origin.span());
        }
        if let Some(Loading::Traffic(traffic)) = &scenario.loading {
            put(Parameter::Total, traffic.total.origin.span());
            for (kind, train) in traffic.trains().enumerate() {
                let first = train.vehicles.first();
                put(Parameter::Speed(kind), train.speed.origin.span());
                put(Parameter::WheelMass(kind), first.and_then(|vehicle| vehicle.wheel_mass.origin.span()));
                put(Parameter::Contact(kind), first.and_then(|vehicle| vehicle.hertz.origin.span()));
                put(Parameter::Bogies(kind), first.and_then(|vehicle| vehicle.bogie_spacing.origin.span()));
            }
        }
        let solve = &scenario.solve;
        put(Parameter::TimeStep, solve.time_step.span());
        put(Parameter::Gravity, solve.gravity.origin.span());
        put(Parameter::ElementsPerBay, solve.elements_per_bay.origin.span());
        put(Parameter::Start, solve.start.and_then(|start| start.origin.span()));
        put(Parameter::Finish, solve.finish.and_then(|finish| finish.origin.span()));
        put(Parameter::Update, solve.update_span);
        put(Parameter::Budget, solve.grains.budget.and_then(|budget| budget.origin.span()));
        put(Parameter::Memory, solve.grains.memory.and_then(|memory| memory.origin.span()));
        origins
    }

    /// The place of a parameter, if it is written in the scene.
    pub fn span(&self, parameter: Parameter) -> Option<Span> {
        self.0.get(&parameter).copied()
    }
}
