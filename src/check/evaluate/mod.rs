//! From trees to typed records: names, arithmetic, dimensions, ranges, profiles as values, defaults. Whatever is remembered of what
//! has been read is remembered here; the rooms above take records and leave them as they are.

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
