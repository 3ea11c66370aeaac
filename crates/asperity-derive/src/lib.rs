//! Derives of the crates of asperity.
//!
//! [`derive@Table`] makes a struct the dictionary of a table of keys: its fields are the keys, their documentation is that of the keys.
//! The declaration of the table and its reader follow from them.

mod field;
mod table;

use proc_macro::TokenStream;
use syn::{DeriveInput, parse_macro_input};

/// Implements `asperity_base::table::Table`: each field is a key of the table.
///
/// ```text
/// /// The leakage of a fluid through the gap.
/// #[derive(Table)]
/// #[table("flow")]                                       its dotted name, or several
/// struct Leakage {
///     /// Viscosity of the fluid, constant.              the meaning: the first paragraph
///     #[key(quantity = Viscosity, range = AboveZero, example = "\"80 mPa s\"", exists = VISCOSITY)]
///     viscosity: f64,
///     /// Direction of the pressure gradient.
///     #[key(choice, default = Along::Both, example = "\"x\"")]
///     along: Along,
///     …
/// }
/// ```
///
/// A key says what it accepts:
///
/// | | |
/// |---|---|
/// | `choice` | one of the words of a `Choice` |
/// | `flag` | true or false |
/// | `count = 1` | a whole number of at least 1 |
/// | `number = "a share"` | a number, with its name in messages, within a `range` |
/// | `quantity = Length` | a quantity of this `Dimension`, within a `range` |
/// | `quantity = kind.drop(), form = "…"` | one whose dimension depends on the fields above, as the documentation describes it |
///
/// `range` is a variant of `Bounds`. A field that is an `Option` is `None` without the key. Any other has a `default`, an
/// expression as a case file would write it, or the key must be given; `written = "\"5 nm\""` writes it with a unit. `absent` tells in
/// words what holds without the key. `exists` is an expression of the type `Exists`.
///
/// `#[table("output", default)]` also implements `Default`, for a table all of whose keys have a default.
#[proc_macro_derive(Table, attributes(table, key))]
pub fn table(input: TokenStream) -> TokenStream {
    let input = parse_macro_input!(input as DeriveInput);
    table::derive(&input).unwrap_or_else(|error| error.to_compile_error()).into()
}
