//! A field of a table: what its attribute and its documentation say.

use proc_macro2::TokenStream;
use quote::quote;
use syn::meta::ParseNestedMeta;
use syn::punctuated::Punctuated;
use syn::{
    Attribute, Data, DeriveInput, Error, Expr, ExprLit, Fields, FieldsNamed, Ident, Lit, LitInt, LitStr,
    Meta, Path, Result, Token, Type, bracketed,
};

/// The values that a key accepts.
enum Accepts {
    /// A word of a `Choice`.
    Choice,
    Flag,
    Count(LitInt),
    /// A whole number of any size.
    Whole(LitInt),
    Number(LitStr),
    Quantity(Expr),
    /// A text, or a type made from it.
    Text,
    /// Values of a special form, with their reader.
    Special(Path),
    /// A table within the table.
    Table,
    /// Tables within the table, with the reader of one.
    Tables(Path),
    /// The keys of another type.
    Part,
}

/// Two numbers along x and y.
#[derive(Clone, Copy)]
enum Two {
    /// Both, or one for both axes.
    Pair,
    /// Both components, or the one along x.
    Vector,
}

/// A field of a table.
pub(crate) struct Field<'a> {
    pub(crate) name: Ident,
    of: &'a Type,
    is_optional: bool,
    accepts: Accepts,
    range: Option<Expr>,
    most: Option<LitInt>,
    /// Two numbers in place of one.
    two: Option<Two>,
    /// Several numbers in place of one, with one of them as an example.
    several: Option<LitStr>,
    /// Spacing of several numbers that a table gives by its ends.
    spacing: Option<Ident>,
    dimension: Option<Ident>,
    form: Option<LitStr>,
    default: Option<Expr>,
    written: Option<LitStr>,
    absent: Option<LitStr>,
    example: Option<LitStr>,
    exists: Option<Expr>,
    beside: Option<Expr>,
    /// Choices with which the key has a meaning; empty if it always has.
    pub(crate) with: Vec<String>,
    meaning: String,
}

impl<'a> Field<'a> {
    /// Reads a field of a struct.
    pub(crate) fn read(field: &'a syn::Field) -> Result<Self> {
        let name = field.ident.as_ref().ok_or_else(|| Error::new_spanned(field, "a key needs a name"))?;
        Self::new(name.clone(), &field.attrs, &field.ty)
    }

    /// Reads a variant of an enum of single values, one of which is given.
    pub(crate) fn named(
        name: Ident,
        attributes: &'a [Attribute],
        of: &'a Type,
        absent: &LitStr,
    ) -> Result<Self> {
        let mut field = Self::new(name, attributes, of)?;
        field.absent.get_or_insert_with(|| absent.clone());
        Ok(field)
    }

    fn new(name: Ident, attributes: &'a [Attribute], of: &'a Type) -> Result<Self> {
        let (is_optional, of) = match inner(of) {
            Some(inner) => (true, inner),
            None => (false, of),
        };
        let attribute = attributes.iter().find(|attribute| attribute.path().is_ident("key"));
        let attribute = attribute.ok_or_else(|| Error::new_spanned(&name, "a key needs #[key(…)]"))?;
        let mut field = Self {
            name,
            of,
            is_optional,
            accepts: Accepts::Part,
            range: None,
            most: None,
            two: None,
            several: None,
            spacing: None,
            dimension: None,
            form: None,
            default: None,
            written: None,
            absent: None,
            example: None,
            exists: None,
            beside: None,
            with: Vec::new(),
            meaning: String::new(),
        };
        let mut accepts = None;
        attribute.parse_nested_meta(|meta: ParseNestedMeta<'_>| {
            let word = meta.path.require_ident()?;
            match word.to_string().as_str() {
                "choice" => accepts = Some(Accepts::Choice),
                "flag" => accepts = Some(Accepts::Flag),
                "text" => accepts = Some(Accepts::Text),
                "table" => accepts = Some(Accepts::Table),
                "tables" => accepts = Some(Accepts::Tables(meta.value()?.parse()?)),
                "part" => accepts = Some(Accepts::Part),
                "count" => accepts = Some(Accepts::Count(meta.value()?.parse()?)),
                "whole" => accepts = Some(Accepts::Whole(meta.value()?.parse()?)),
                "number" => accepts = Some(Accepts::Number(meta.value()?.parse()?)),
                "quantity" => accepts = Some(Accepts::Quantity(meta.value()?.parse()?)),
                "special" => accepts = Some(Accepts::Special(meta.value()?.parse()?)),
                "pair" => field.two = Some(Two::Pair),
                "vector" => field.two = Some(Two::Vector),
                "several" => field.several = Some(meta.value()?.parse()?),
                "spacing" => field.spacing = Some(meta.value()?.parse()?),
                "range" => field.range = Some(meta.value()?.parse()?),
                "most" => field.most = Some(meta.value()?.parse()?),
                "dimension" => field.dimension = Some(meta.value()?.parse()?),
                "form" => field.form = Some(meta.value()?.parse()?),
                "default" => field.default = Some(meta.value()?.parse()?),
                "written" => field.written = Some(meta.value()?.parse()?),
                "absent" => field.absent = Some(meta.value()?.parse()?),
                "example" => field.example = Some(meta.value()?.parse()?),
                "exists" => field.exists = Some(meta.value()?.parse()?),
                "beside" => field.beside = Some(meta.value()?.parse()?),
                "with" => {
                    let value = meta.value()?;
                    let kinds;
                    bracketed!(kinds in value);
                    let kinds = Punctuated::<LitStr, Token![,]>::parse_terminated(&kinds)?;
                    field.with = kinds.iter().map(LitStr::value).collect();
                }
                _ => return Err(meta.error("no such word in #[key]")),
            }
            Ok(())
        })?;
        field.accepts =
            accepts.ok_or_else(|| Error::new_spanned(attribute, "#[key] says what the key accepts"))?;
        if field.part().is_none() {
            field.meaning = meaning(attributes, &field.name)?;
        }
        Ok(field)
    }

    /// The type whose keys stand in place of the field, if it is a part.
    pub(crate) fn part(&self) -> Option<&'a Type> {
        matches!(self.accepts, Accepts::Part).then_some(self.of)
    }

    /// The declaration of the key.
    pub(crate) fn declaration(&self) -> Result<TokenStream> {
        let name = self.name.to_string();
        let (kind, meaning) = (self.kind()?, &self.meaning);
        let example = match &self.example {
            Some(example) => quote!(#example),
            None if matches!(self.accepts, Accepts::Table | Accepts::Tables(_)) => quote!(""),
            None => return Err(Error::new_spanned(&self.name, "a key needs an example")),
        };
        let fallback = match (&self.absent, &self.default) {
            (Some(text), _) => quote!(Absent(#text)),
            (None, Some(default)) => {
                let text = match &self.written {
                    Some(text) => text.value(),
                    None => written(default)?,
                };
                quote!(Value(#text))
            }
            (None, None) if self.written.is_some() => {
                let text = &self.written;
                quote!(Value(#text))
            }
            (None, None) if self.is_optional => {
                return Err(Error::new_spanned(
                    &self.name,
                    "an optional key needs `absent`: what holds without it",
                ));
            }
            (None, None) => quote!(Required),
        };
        let beside = self.beside.as_ref().map_or(quote!(&[]), |beside| quote!(const { &#beside }));
        let exists = match &self.exists {
            Some(exists) => quote!(#exists),
            None => quote!(::asperity_base::table::Exists::Undeclared),
        };
        Ok(quote! {
            ::asperity_base::table::Key {
                name: #name,
                kind: #kind,
                default: ::asperity_base::table::Fallback::#fallback,
                example: #example,
                text: #meaning,
                exists: #exists,
                beside: #beside,
            }
        })
    }

    /// The value of the field without its key.
    pub(crate) fn default(&self) -> Result<TokenStream> {
        match &self.default {
            Some(default) => Ok(quote!(#default)),
            None if self.is_optional => Ok(quote!(None)),
            None => Err(Error::new_spanned(&self.name, "a table with `default` has no required key")),
        }
    }

    /// The statement that reads the field from `source` into a variable of its name, by its declaration
    /// `key`.
    pub(crate) fn reader(&self, key: &TokenStream) -> TokenStream {
        let (name, of) = (&self.name, self.of);
        if self.part().is_some() {
            let read = quote!(<#of as ::asperity_base::table::Part>::read(__source)?);
            return if self.is_optional {
                let gives = quote!(::asperity_base::table::gives::<#of>(__source));
                quote!(let #name = if #gives { Some(#read) } else { None };)
            } else {
                quote!(let #name = #read;)
            };
        }
        let given = self.value(key);
        let read = match &self.default {
            _ if self.is_optional => given,
            Some(default) => quote!((#given).unwrap_or(#default)),
            None => quote!((#given).ok_or_else(|| __source.missing(#key))?),
        };
        quote!(let #name = #read;)
    }

    /// The expression of the value of the key, `None` if it is not given.
    pub(crate) fn value(&self, key: &TokenStream) -> TokenStream {
        let of = self.of;
        let read = match &self.accepts {
            Accepts::Choice => quote!(::asperity_base::table::choice::<#of>(value)),
            Accepts::Flag => quote!(value.flag()),
            Accepts::Count(_) => quote!(value.count(#key, &(#key).kind)),
            Accepts::Whole(least) => quote!(value.whole(#least)),
            Accepts::Number(_) | Accepts::Quantity(_) if self.several.is_some() => {
                let (one, example, spacing) = (self.number(), &self.several, self.spacing());
                let several = quote!(value.several(#key, &#one, #spacing, #example));
                match self.two {
                    Some(_) => several,
                    None => {
                        quote!(#several.map(|values| values.into_iter().map(|[value, _]| value).collect()))
                    }
                }
            }
            Accepts::Number(_) | Accepts::Quantity(_) if self.two.is_some() => quote!(value.pair(#key)),
            Accepts::Quantity(dimension) if self.form.is_some() => {
                let bounds = self.bounds();
                quote!(value.real(#key, &::asperity_base::table::Kind::Quantity(#dimension, #bounds)))
            }
            Accepts::Number(_) | Accepts::Quantity(_) => quote!(value.real(#key, &(#key).kind)),
            Accepts::Text => quote!(value.text().map(<#of>::from)),
            Accepts::Special(read) => quote!(#read(value, #key)),
            Accepts::Table => quote!(<#of as ::asperity_base::table::Table>::read(value.table()?.as_ref())),
            Accepts::Tables(read) => quote!(::asperity_base::table::tables(value, #read)),
            Accepts::Part => unreachable!("a part reads itself"),
        };
        quote!(::asperity_base::table::optional(__source, #key, |value| #read)?)
    }

    /// The statements that check a `value`, a reference, against the bounds of its declaration `key`.
    pub(crate) fn checker(&self, value: &TokenStream, key: &TokenStream) -> TokenStream {
        let of = self.of;
        let one = match &self.accepts {
            Accepts::Part => quote!(<#of as ::asperity_base::table::Part>::check(value)?;),
            Accepts::Count(_) | Accepts::Whole(_) => {
                quote!(::asperity_base::table::check(#key, *value as f64)?;)
            }
            Accepts::Number(_) | Accepts::Quantity(_) if self.several.is_some() => return TokenStream::new(),
            Accepts::Number(_) | Accepts::Quantity(_) if self.two.is_some() => {
                quote!(for value in value { ::asperity_base::table::check(#key, *value)?; })
            }
            Accepts::Number(_) | Accepts::Quantity(_) => {
                quote!(::asperity_base::table::check(#key, *value)?;)
            }
            _ => return TokenStream::new(),
        };
        if self.is_optional {
            quote!(if let Some(value) = #value { #one })
        } else {
            quote!({ let value = #value; #one })
        }
    }

    /// The kind of the key.
    fn kind(&self) -> Result<TokenStream> {
        let of = self.of;
        let kind = match (&self.accepts, &self.form) {
            (Accepts::Choice, _) => quote!(Choice(<#of as ::asperity_base::choice::Choice>::NAMES)),
            (Accepts::Flag, _) => quote!(Flag),
            (Accepts::Text, _) => quote!(Text),
            (Accepts::Table, _) => quote!(Table),
            (Accepts::Tables(_), _) => quote!(Tables),
            (Accepts::Count(least), _) => {
                let most = self.most.as_ref().map_or(quote!(u64::MAX), |most| quote!(#most));
                quote!(Count { least: #least, most: #most })
            }
            (Accepts::Whole(least), _) => quote!(Count { least: #least, most: u64::MAX }),
            (Accepts::Number(_) | Accepts::Quantity(_), form) if self.several.is_some() => {
                let form = match form {
                    Some(form) => quote!(#form),
                    None => quote!(::asperity_base::table::SEVERAL),
                };
                let one = self.number();
                quote!(Other { dimension: #one.dimension(), value: #form })
            }
            (Accepts::Quantity(_), Some(form)) => quote!(Other { dimension: None, value: #form }),
            (Accepts::Number(_) | Accepts::Quantity(_), _) => return Ok(self.number()),
            (Accepts::Special(_), form) => {
                let form = form
                    .as_ref()
                    .ok_or_else(|| Error::new_spanned(&self.name, "a special value needs its `form`"))?;
                let dimension = match &self.dimension {
                    Some(dimension) => quote!(Some(::asperity_base::units::Dimension::#dimension)),
                    None => quote!(None),
                };
                quote!(Other { dimension: #dimension, value: #form })
            }
            (Accepts::Part, _) => unreachable!("a part declares its own keys"),
        };
        Ok(quote!(::asperity_base::table::Kind::#kind))
    }

    /// The kind of a number or a quantity, or of two.
    fn number(&self) -> TokenStream {
        let bounds = self.bounds();
        let one = match &self.accepts {
            Accepts::Number(noun) => quote!(::asperity_base::table::Kind::Number(#noun, #bounds)),
            Accepts::Quantity(dimension) => quote! {
                ::asperity_base::table::Kind::Quantity(::asperity_base::units::Dimension::#dimension, #bounds)
            },
            _ => unreachable!("no number"),
        };
        match self.two {
            None => one,
            Some(Two::Pair) => quote!(::asperity_base::table::Kind::Pair(&#one)),
            Some(Two::Vector) => quote!(::asperity_base::table::Kind::Vector(&#one)),
        }
    }

    fn spacing(&self) -> TokenStream {
        match &self.spacing {
            Some(spacing) => quote!(::asperity_base::table::Spacing::#spacing),
            None => quote!(::asperity_base::table::Spacing::Log),
        }
    }

    fn bounds(&self) -> TokenStream {
        match &self.range {
            Some(range) => quote!(::asperity_base::table::Bounds::#range),
            None => quote!(::asperity_base::table::Bounds::Any),
        }
    }
}

/// The named fields of a struct.
pub(crate) fn fields(input: &DeriveInput) -> Result<&FieldsNamed> {
    match &input.data {
        Data::Struct(data) => match &data.fields {
            Fields::Named(fields) => Ok(fields),
            _ => Err(Error::new_spanned(input, "a table is a struct with named fields")),
        },
        _ => Err(Error::new_spanned(input, "a table is a struct")),
    }
}

/// The type in an `Option`.
fn inner(of: &Type) -> Option<&Type> {
    let Type::Path(path) = of else { return None };
    let last = path.path.segments.last().filter(|last| last.ident == "Option")?;
    let syn::PathArguments::AngleBracketed(arguments) = &last.arguments else { return None };
    match arguments.args.first()? {
        syn::GenericArgument::Type(inner) => Some(inner),
        _ => None,
    }
}

/// The first paragraph of a documentation, as part of a sentence: without a capital and the full stop.
fn meaning(attributes: &[Attribute], name: &Ident) -> Result<String> {
    let mut words = Vec::new();
    for attribute in attributes.iter().filter(|attribute| attribute.path().is_ident("doc")) {
        let Meta::NameValue(doc) = &attribute.meta else { continue };
        let Expr::Lit(ExprLit { lit: Lit::Str(line), .. }) = &doc.value else { continue };
        let line = line.value();
        if line.trim().is_empty() {
            break;
        }
        words.push(line.trim().to_owned());
    }
    // A table of a case in brackets is escaped, because it is no link.
    let text = words.join(" ").replace("\\[", "[").replace("\\]", "]");
    let text = text.strip_suffix('.').unwrap_or(&text);
    let mut characters = text.chars();
    let first = characters
        .next()
        .ok_or_else(|| Error::new_spanned(name, "a key needs its meaning, as documentation"))?;
    // A symbol, an abbreviation and a name in the genitive keep their capital.
    let is_name = text.split(' ').next().is_some_and(|word| word.ends_with("'s"));
    let is_word = characters.clone().next().is_some_and(char::is_lowercase) && !is_name;
    if is_word { Ok(first.to_lowercase().chain(characters).collect()) } else { Ok(text.to_owned()) }
}

/// A default as a case file would write it: a number, true or false, or the word of a choice.
fn written(default: &Expr) -> Result<String> {
    match default {
        Expr::Lit(ExprLit { lit: Lit::Bool(flag), .. }) => Ok(flag.value.to_string()),
        Expr::Lit(ExprLit { lit: Lit::Int(number), .. }) => Ok(number.base10_digits().to_owned()),
        Expr::Lit(ExprLit { lit: Lit::Float(number), .. }) => Ok(number.to_string()),
        Expr::Path(path) => {
            let variant = &path.path.segments.last().expect("a path has segments").ident;
            Ok(format!("\"{}\"", kebab(variant)))
        }
        _ => {
            Err(Error::new_spanned(default, "a default is a number, true or false, or a variant of a choice"))
        }
    }
}

/// The name of a variant as the word of a choice: `LowPass` is `low-pass`.
pub(crate) fn kebab(variant: &Ident) -> String {
    separated(variant, '-')
}

/// The name of a variant as a key: `MeanPressure` is `mean_pressure`.
pub(crate) fn snake(variant: &Ident) -> String {
    separated(variant, '_')
}

fn separated(variant: &Ident, separator: char) -> String {
    let mut word = String::new();
    for (index, letter) in variant.to_string().char_indices() {
        if letter.is_uppercase() && index > 0 {
            word.push(separator);
        }
        word.extend(letter.to_lowercase());
    }
    word
}
