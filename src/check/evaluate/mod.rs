//! From trees to typed records: names, arithmetic, dimensions, ranges, profiles as values, defaults. All state of
//! reading is kept here; the modules above use records and do not change them.

mod arithmetic;
mod columns;
mod combine;
mod complete;
mod declarations;
pub mod evaluator;
mod fit;
pub mod measure;
mod names;
pub mod number;
mod objects;
pub mod offers;
mod pairs;
mod profile;
mod random;
pub mod records;
pub mod shape;
mod unit_mistakes;
pub mod value;
mod words;
pub mod written;
