//! The derive of a table.

use proc_macro2::TokenStream;
use quote::quote;
use syn::parse::ParseStream;
use syn::{Data, DeriveInput, Error, Fields, LitStr, Result, Token};

use crate::field::Key;

pub(crate) fn derive(input: &DeriveInput) -> Result<TokenStream> {
    let Data::Struct(data) = &input.data else {
        return Err(Error::new_spanned(input, "a table is a struct"));
    };
    let Fields::Named(fields) = &data.fields else {
        return Err(Error::new_spanned(input, "a table is a struct with named fields"));
    };
    let attribute = input.attrs.iter().find(|attribute| attribute.path().is_ident("table"));
    let attribute =
        attribute.ok_or_else(|| Error::new_spanned(input, "a table needs its name: #[table(\"…\")]"))?;
    let (names, has_default) = attribute.parse_args_with(names)?;
    let keys = fields.named.iter().map(Key::of).collect::<Result<Vec<_>>>()?;
    let declarations = keys.iter().map(Key::declaration).collect::<Result<Vec<_>>>()?;
    let readers = keys.iter().enumerate().map(|(index, key)| key.reader(index));
    let fields = keys.iter().map(|key| key.name);
    let table = &input.ident;
    let default = match has_default {
        false => TokenStream::new(),
        true => {
            let values = keys.iter().map(Key::default).collect::<Result<Vec<_>>>()?;
            let fields = fields.clone();
            quote! {
                impl Default for #table {
                    fn default() -> Self {
                        Self { #(#fields: #values),* }
                    }
                }
            }
        }
    };
    Ok(quote! {
        #default

        impl ::asperity_base::table::Table for #table {
            const SECTION: ::asperity_base::table::Section = ::asperity_base::table::Section {
                tables: &[#(#names),*],
                kind: "",
                keys: &[#(#declarations),*],
            };

            fn read(source: &dyn ::asperity_base::table::Source) -> ::asperity_base::error::Result<Self> {
                #(#readers)*
                Ok(Self { #(#fields),* })
            }
        }
    })
}

/// The names of a table, and whether it has a default.
fn names(input: ParseStream<'_>) -> Result<(Vec<LitStr>, bool)> {
    let (mut names, mut has_default) = (Vec::new(), false);
    while !input.is_empty() {
        match input.peek(Token![default]) {
            true => {
                input.parse::<Token![default]>()?;
                has_default = true;
            }
            false => names.push(input.parse()?),
        }
        if !input.is_empty() {
            input.parse::<Token![,]>()?;
        }
    }
    Ok((names, has_default))
}
