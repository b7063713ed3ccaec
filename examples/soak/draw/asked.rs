//! Places, and what is asked of a scene: responses, comparisons, rules and studies.

use super::Drawing;
use super::aim::want;
use super::number::plain;
use trackbed::diag::Code;
use trackbed::scenario::response::{Place, Response};
use trackbed::schema::Varies;
use trackbed::units::{Dimension, usual_units};

/// Sleepers on which places are drawn, on either side of a boundary; every section has more.
const NEAR: usize = 12;

impl Drawing<'_> {
    /// A sleeper or a chainage near the first boundary.
    pub(super) fn place(&mut self) -> String {
        let most = if self.aim.is_rig() { 1 } else { NEAR };
        let number = self.between([1, most]);
        let sign = if self.sections > 1 && self.chance(0.6) { "-" } else { "" };
        match !self.aim.is_rig() && self.chance(0.2) {
            true => format!("{sign}{} m", plain(number as f64 * 0.5)),
            false => format!("{sign}{number} sleepers"),
        }
    }

    /// Some sleepers on one side of the first boundary.
    pub(super) fn span(&mut self) -> String {
        let first = self.between([1, 4]);
        let last = first + self.between([1, NEAR - 4]);
        let unit = if self.chance(0.2) { "m" } else { "sleepers" };
        match self.sections > 1 && self.chance(0.75) {
            true => format!("-{last} .. -{first} {unit}"),
            false => format!("{first} .. {last} {unit}"),
        }
    }

    pub(super) fn response(&mut self, path: &str) -> &'static str {
        let only = want(self.aim, path).map_or(&[][..], |want| want.only);
        // mostly what this kind of scene yields
        if !only.is_empty() && self.chance(0.95) {
            return only[self.dice.roll(only.len())];
        }
        Response::ALL[self.dice.roll(Response::ALL.len())].name()
    }

    pub(super) fn rule(&mut self) -> &'static str {
        let rules: Vec<&'static str> = Code::ALL.iter().filter_map(|code| code.rule()).collect();
        rules[self.dice.roll(rules.len())]
    }

    /// One number of a response.
    pub(super) fn expression(&mut self, path: &str) -> String {
        let name = self.response(path);
        if Response::of_name(name).is_some_and(|response| response.place() == Place::Scene) {
            return name.into();
        }
        let reduction = self.dice.pick(&["max", "min", "mean", "rms"]);
        match self.transitions.len() < 2 && !self.aim.is_rig() && self.chance(0.2) {
            true => format!("{reduction}({name}, over = {})", self.span()),
            false => format!("{reduction}({name})"),
        }
    }

    pub(super) fn comparison(&mut self, path: &str) -> String {
        let left = self.expression(path);
        let named = left.split(['(', ')', ',']).find_map(|part| Response::of_name(part.trim()));
        let unit = named.map_or("m", |response| response.unit());
        let units = usual_units(Dimension::of_unit(unit));
        let unit = if units.is_empty() { unit } else { units[self.dice.roll(units.len())] };
        let unit = if unit == "1" { "" } else { unit };
        let bound = self.between([1, 500]);
        format!("{left} {} {}", self.dice.pick(&["<", "<=", ">", ">="]), format!("{bound} {unit}").trim_end())
    }

    /// Values of one or two numbers of the scene.
    pub(super) fn axes(&mut self) -> Option<String> {
        let (path, field, measure) = self.varied()?;
        let measure = trackbed::schema::Measure { varies: Varies::No, ..*measure };
        let values: Option<Vec<String>> = (0..2).map(|_| self.quantity(&field, &measure)).collect();
        Some(format!("[{path}: [{}]]", values?.join(", ")))
    }

    /// A number of the scene, set anew.
    pub(super) fn settings(&mut self) -> Option<String> {
        let (path, field, measure) = self.varied()?;
        let value = self.quantity(&field, measure)?;
        Some(format!("[{path}: {value}]"))
    }

    fn varied(&mut self) -> Option<(String, String, &'static trackbed::schema::Measure)> {
        let at = self.dice.roll(self.numbers.len());
        self.numbers.get(at).cloned()
    }
}
