//! Named choices of the command line; names, help texts and values are defined in the crate of the values.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

/// A parser of one of these choices: name, help text, value.
pub fn choice<T: Clone + Send + Sync + 'static>(
    choices: &'static [(&'static str, &'static str, T)],
) -> impl TypedValueParser<Value = T> {
    let names = choices.iter().map(|(name, help, _)| PossibleValue::new(*name).help(*help));
    PossibleValuesParser::new(names).map(|given| {
        let chosen = choices.iter().find(|(name, ..)| *name == given);
        chosen.expect("invariant: the parser takes only these names").2.clone()
    })
}
