//! The derive of a table.

use proc_macro2::TokenStream;
use quote::quote;
use syn::parse::ParseStream;
use syn::{DeriveInput, Error, LitStr, Path, Result, Token};

use crate::field::{Field, fields};
use crate::part;

/// Names of a table, and what else its attribute says.
struct Attribute {
    names: Vec<LitStr>,
    has_default: bool,
    check: Option<Path>,
}

pub(crate) fn derive(input: &DeriveInput) -> Result<TokenStream> {
    let fields = fields(input)?;
    let attribute = input.attrs.iter().find(|attribute| attribute.path().is_ident("table"));
    let attribute =
        attribute.ok_or_else(|| Error::new_spanned(input, "a table needs its name: #[table(\"…\")]"))?;
    let Attribute { names, has_default, check } = attribute.parse_args_with(Attribute::parse)?;
    let fields = fields.named.iter().map(Field::read).collect::<Result<Vec<_>>>()?;
    let declarations = part::declarations(&fields)?;
    let list = quote!(<Self as ::asperity_base::table::Table>::KEYS);
    let keys = part::keys(&fields, &list);
    let sections = part::sections(&fields, &list, &quote!(<Self as ::asperity_base::table::Table>::TABLES));
    let read = part::reader(&fields, &list, check.as_ref());
    let check = part::checkers(&fields, &list, |name| quote!(&self.#name));
    let table = &input.ident;
    let default = if has_default {
        let values = fields.iter().map(Field::default).collect::<Result<Vec<_>>>()?;
        let fields = fields.iter().map(|field| &field.name);
        quote! {
            impl Default for #table {
                fn default() -> Self {
                    Self { #(#fields: #values),* }
                }
            }
        }
    } else {
        TokenStream::new()
    };
    Ok(quote! {
        #default

        impl ::asperity_base::table::Table for #table {
            const TABLES: &'static [&'static str] = &[#(#names),*];
            const KEYS: &'static [::asperity_base::table::Key] = &[#(#declarations),*];

            #[allow(clippy::vec_init_then_push, reason = "one statement for each field")]
            fn sections() -> Vec<::asperity_base::table::Section> {
                let mut keys = Vec::new();
                #keys
                let own = ::asperity_base::table::Section {
                    tables: <Self as ::asperity_base::table::Table>::TABLES,
                    kind: "",
                    keys: keys.leak(),
                };
                #[allow(unused_mut, reason = "a table may have no parts")]
                let mut sections = vec![own];
                #sections
                sections
            }

            fn read(__source: &dyn ::asperity_base::table::Source) -> ::asperity_base::error::Result<Self> {
                #read
            }

            fn check(&self) -> ::asperity_base::error::Result<()> {
                #check
                Ok(())
            }
        }
    })
}

impl Attribute {
    fn parse(input: ParseStream<'_>) -> Result<Self> {
        let mut attribute = Self { names: Vec::new(), has_default: false, check: None };
        while !input.is_empty() {
            if input.peek(Token![default]) {
                input.parse::<Token![default]>()?;
                attribute.has_default = true;
            } else if input.peek(LitStr) {
                attribute.names.push(input.parse()?);
            } else {
                attribute.check = Some(part::check(input)?);
            }
            if !input.is_empty() {
                input.parse::<Token![,]>()?;
            }
        }
        Ok(attribute)
    }
}
