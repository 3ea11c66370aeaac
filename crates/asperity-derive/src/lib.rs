//! Derives of the crates of asperity.
//!
//! [`derive@Table`] makes a struct the dictionary of a table of keys: its fields are the keys, their
//! documentation is that of the keys. The declaration of the table and its reader follow from them.
//! [`derive@Part`] does the same for keys that stand together in a table.

mod field;
mod part;
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
/// | `count = 1` | a number of things of at least 1, and at most `most` |
/// | `whole = 0` | a whole number of at least 0 and of any size, a `u64` |
/// | `number = "a share"` | a number, with its name in messages, within a `range` |
/// | `quantity = Length` | a quantity of this `Dimension`, within a `range` |
/// | … and `pair` | one of these for both axes, or two |
/// | … and `vector` | its component along x, or those along x and y |
/// | … and `several = "\"1 N\""` | a list of these, with an example of one, or a table of its ends; `spacing = Linear` for equal steps |
/// | `quantity = kind.drop(), form = "…"` | one whose dimension depends on the fields above, as the documentation describes it |
/// | `text` | a text, or a type made from it |
/// | `table` | a table, whose struct derives [`derive@Table`] |
/// | `tables = reader` | an array of tables, each of which a function reads |
/// | `special = reader, form = "…"` | values that a function reads, of a `dimension`, if any |
/// | `part` | the keys of a type that derives [`derive@Part`]; an `Option` of it is `None` if none of them is given |
///
/// `range` is a variant of `Bounds`. A field that is an `Option` is `None` without the key. Any other field
/// has a `default`, or its key must be given. A default is an expression as a case file writes it;
/// `written = "\"5 nm\""` writes it with a unit. The `written` value of an `Option` is the one that the
/// reader of the whole case puts in place of `None`. `absent` describes in words what holds without the key.
/// `exists` is an expression of the type `Exists`, `beside` an array of the type `Beside`. A key has a
/// meaning only `with = ["file"]`, one of several kinds, if it names them.
///
/// `#[table("output", default)]` also implements `Default`, for a table all of whose keys have a default.
/// `#[table("…", check = function)]` names a function that gets the struct and the source, and returns an
/// error for values that do not go together.
#[proc_macro_derive(Table, attributes(table, key))]
pub fn table(input: TokenStream) -> TokenStream {
    let input = parse_macro_input!(input as DeriveInput);
    table::derive(&input).unwrap_or_else(|error| error.to_compile_error()).into()
}

/// Implements `asperity_base::table::Part`: keys that stand together in a table, the fields of a struct or
/// the variants of an enum.
///
/// ```text
/// #[derive(Part)]                                        all of them
/// struct HeightDistribution {
///     /// Skewness of the heights.
///     #[key(number = "a number", default = 0.0, example = "-1")]
///     ssk: f64,
///     …
/// }
///
/// #[derive(Part)]                                        exactly one of them, each named as its variant
/// #[part(absent = "exactly one of the two", hint = "for example `sq = \"1 um\"`")]
/// enum Amplitude {
///     /// Rms height.
///     #[key(quantity = Length, range = AboveZero, example = "\"0.2 um\"")]
///     Sq(f64),
///     …
/// }
///
/// #[derive(Part)]                                        a key that names a variant, which gives its fields a meaning
/// #[part(key = "law", example = "\"arrhenius\"", meaning = "law of the growth")]
/// enum FilmLaw {
///     Arrhenius { /// Rate. #[key(…)] rate: f64, … },
///     …
/// }
///
/// #[derive(Part)]                                        exactly one kind, named as the first of its keys
/// #[part(hint = "for example `file = \"disc.x3p\"`")]
/// enum Source {
///     File { /// Path. #[key(…)] file: PathBuf, … },
///     …
/// }
/// ```
#[proc_macro_derive(Part, attributes(part, key))]
pub fn part(input: TokenStream) -> TokenStream {
    let input = parse_macro_input!(input as DeriveInput);
    part::derive(&input).unwrap_or_else(|error| error.to_compile_error()).into()
}
