//! One source file with many mutants in it, each asleep behind `crate::mutation::is(its number)`.

use std::{collections::HashMap, ops::Range};

use proc_macro2::LineColumn;
use syn::{spanned::Spanned, visit::Visit};

use crate::Mutant;

/// Text that goes into the source.
struct Insertion {
    at: usize,
    /// Among those at one place: what closes before what opens, the inner of what closes first, the outer of what opens.
    rank: (bool, isize),
    text: String,
    /// The mutant whose code this is.
    mutant: Option<u32>,
}

/// A source with its mutants.
pub struct Woven {
    pub text: String,
    /// Where the code of each mutant lies in the text.
    code: Vec<(u32, Range<usize>)>,
    /// Where the expressions lie that have mutants.
    sites: Vec<(Vec<u32>, Range<usize>)>,
    /// The mutants that found their place.
    pub placed: Vec<u32>,
}

impl Woven {
    /// The mutants to which an error at a place of the text is due: whose code it is in, or else those of the smallest
    /// expression around it.
    pub fn culprits(&self, places: &[Range<usize>]) -> Vec<u32> {
        let holds = |outer: &Range<usize>, inner: &Range<usize>| outer.start <= inner.start && inner.end <= outer.end;
        let mut found: Vec<u32> = places
            .iter()
            .filter_map(|place| {
                let around = self.code.iter().filter(|(_, range)| holds(range, place));
                around.min_by_key(|(_, range)| range.len()).map(|(mutant, _)| *mutant)
            })
            .collect();
        if found.is_empty() {
            for place in places {
                let around = self.sites.iter().filter(|(_, range)| holds(range, place));
                found.extend(around.min_by_key(|(_, range)| range.len()).iter().flat_map(|(mutants, _)| mutants));
            }
        }
        found
    }
}

/// Weaves mutants into a source. Those for which it has no place are left out.
pub fn weave(source: &str, mutants: &[&Mutant]) -> Result<Woven, syn::Error> {
    let mut weaver = Weaver {
        source,
        lines: starts_of_lines(source),
        by_place: HashMap::new(),
        insertions: vec![],
        sites: vec![],
        placed: vec![],
    };
    for mutant in mutants {
        weaver.by_place.entry((mutant.line, mutant.column, mutant.genre.clone())).or_default().push(mutant);
    }
    weaver.visit_file(&syn::parse_file(source)?);
    Ok(weaver.finish())
}

fn starts_of_lines(source: &str) -> Vec<usize> {
    std::iter::once(0).chain(source.match_indices('\n').map(|(at, _)| at + 1)).collect()
}

struct Weaver<'a> {
    source: &'a str,
    lines: Vec<usize>,
    by_place: HashMap<(usize, usize, String), Vec<&'a Mutant>>,
    insertions: Vec<Insertion>,
    sites: Vec<(Vec<u32>, Range<usize>)>,
    placed: Vec<u32>,
}

impl<'a> Weaver<'a> {
    fn offset(&self, place: LineColumn) -> usize {
        let line = self.lines[place.line - 1];
        let column = self.source[line..].char_indices().nth(place.column).map_or(0, |(at, _)| at);
        line + column
    }

    fn range(&self, item: &impl Spanned) -> Range<usize> {
        let span = item.span();
        self.offset(span.start())..self.offset(span.end())
    }

    fn text(&self, item: &impl Spanned) -> &'a str {
        &self.source[self.range(item)]
    }

    /// The mutants of a kind whose span begins where the item does.
    fn at(&mut self, item: &impl Spanned, genre: &str) -> Vec<&'a Mutant> {
        let start = item.span().start();
        let found = self.by_place.remove(&(start.line, start.column + 1, genre.into())).unwrap_or_default();
        self.placed.extend(found.iter().map(|mutant| mutant.number));
        found
    }

    fn open(&mut self, at: usize, extent: usize, text: String) {
        self.insertions.push(Insertion { at, rank: (true, -(extent as isize)), text, mutant: None });
    }

    fn close(&mut self, at: usize, extent: usize, text: String, mutant: Option<u32>) {
        self.insertions.push(Insertion { at, rank: (false, extent as isize), text, mutant });
    }

    /// `(if none { original } else if is(1) { one } else if is(2) { two } ...)`: the original comes first, so that an
    /// error of types is one of the mutant.
    fn choice(&mut self, range: Range<usize>, variants: Vec<(u32, String)>) {
        if variants.is_empty() {
            return;
        }
        let none: Vec<_> = variants.iter().map(|(number, _)| format!("!{}", is(*number))).collect();
        self.sites.push((variants.iter().map(|(number, _)| *number).collect(), range.clone()));
        self.open(range.start, range.len(), format!("(if {} {{ ", none.join(" && ")));
        let last = variants.len() - 1;
        for (i, (number, code)) in variants.into_iter().enumerate() {
            let head = if i == last { " } else { ".into() } else { format!(" }} else if {} {{ ", is(number)) };
            self.close(range.end, range.len(), head, None);
            self.close(range.end, range.len(), code, Some(number));
        }
        self.close(range.end, range.len(), " })".into(), None);
    }

    fn body(&mut self, block: &syn::Block) {
        let Some(first) = block.stmts.first() else { return };
        let mutants = self.at(first, "FnValue");
        let at = self.offset(block.brace_token.span.open().end());
        for mutant in mutants {
            self.close(at, usize::MAX >> 1, format!(" if {} {{ ", is(mutant.number)), None);
            self.close(at, usize::MAX >> 1, format!("return {};", mutant.replacement), Some(mutant.number));
            self.close(at, usize::MAX >> 1, " } ".into(), None);
        }
    }

    fn finish(mut self) -> Woven {
        // A stable sort: what is written at one place in several pieces stays in order.
        self.insertions.sort_by_key(|insertion| (insertion.at, insertion.rank));
        let (mut text, mut code, mut from) = (String::new(), vec![], 0);
        // Places of the source, and where they came to lie in the text: before what is inserted there, and after it.
        let (mut before, mut after) = (HashMap::new(), HashMap::new());
        for insertion in &self.insertions {
            text.push_str(&self.source[from..insertion.at]);
            from = insertion.at;
            before.entry(insertion.at).or_insert(text.len());
            if let Some(mutant) = insertion.mutant {
                code.push((mutant, text.len()..text.len() + insertion.text.len()));
            }
            text.push_str(&insertion.text);
            after.insert(insertion.at, text.len());
        }
        text.push_str(&self.source[from..]);
        let sites =
            self.sites.into_iter().map(|(mutants, range)| (mutants, before[&range.start]..after[&range.end])).collect();
        Woven { text, code, sites, placed: self.placed }
    }
}

fn is(number: u32) -> String {
    format!("crate::mutation::is({number})")
}

impl<'ast> Visit<'ast> for Weaver<'_> {
    fn visit_item_fn(&mut self, item: &'ast syn::ItemFn) {
        self.body(&item.block);
        syn::visit::visit_item_fn(self, item);
    }

    fn visit_impl_item_fn(&mut self, item: &'ast syn::ImplItemFn) {
        self.body(&item.block);
        syn::visit::visit_impl_item_fn(self, item);
    }

    fn visit_trait_item_fn(&mut self, item: &'ast syn::TraitItemFn) {
        item.default.iter().for_each(|block| self.body(block));
        syn::visit::visit_trait_item_fn(self, item);
    }

    // What the compiler evaluates has no mutants: by the time one could wake, it is a number.
    fn visit_item_const(&mut self, _: &'ast syn::ItemConst) {}
    fn visit_impl_item_const(&mut self, _: &'ast syn::ImplItemConst) {}
    fn visit_trait_item_const(&mut self, _: &'ast syn::TraitItemConst) {}
    fn visit_item_static(&mut self, _: &'ast syn::ItemStatic) {}
    fn visit_variant(&mut self, _: &'ast syn::Variant) {}
    fn visit_type(&mut self, _: &'ast syn::Type) {}
    fn visit_expr_const(&mut self, _: &'ast syn::ExprConst) {}

    fn visit_expr_repeat(&mut self, repeat: &'ast syn::ExprRepeat) {
        self.visit_expr(&repeat.expr);
    }

    fn visit_expr_binary(&mut self, binary: &'ast syn::ExprBinary) {
        let variants = self.at(&binary.op, "BinaryOperator").into_iter().map(|mutant| {
            let (left, right) = (self.text(&*binary.left), self.text(&*binary.right));
            (mutant.number, format!("({left}) {} ({right})", mutant.replacement))
        });
        let variants = variants.collect();
        self.choice(self.range(binary), variants);
        syn::visit::visit_expr_binary(self, binary);
    }

    fn visit_expr_unary(&mut self, unary: &'ast syn::ExprUnary) {
        let mutants = self.at(&unary.op, "UnaryOperator");
        let variants = mutants.iter().map(|mutant| (mutant.number, self.text(&*unary.expr).into())).collect();
        self.choice(self.range(unary), variants);
        syn::visit::visit_expr_unary(self, unary);
    }

    fn visit_arm(&mut self, arm: &'ast syn::Arm) {
        for mutant in self.at(arm, "MatchArm") {
            let range = self.range(&arm.pat);
            self.sites.push((vec![mutant.number], range.clone()));
            self.open(range.start, 0, String::new());
            self.close(range.end, usize::MAX >> 1, format!(" if !{}", is(mutant.number)), None);
        }
        if let Some((_, guard)) = &arm.guard {
            let range = self.range(&**guard);
            for mutant in self.at(&**guard, "MatchArmGuard") {
                self.sites.push((vec![mutant.number], range.clone()));
                let head = if mutant.replacement == "true" {
                    format!("({} || (", is(mutant.number))
                } else {
                    format!("(!{} && (", is(mutant.number))
                };
                // Around a mutated expression that is the whole guard.
                self.open(range.start, range.len() + 1, head);
                self.close(range.end, range.len() + 1, "))".into(), None);
            }
        }
        syn::visit::visit_arm(self, arm);
    }

    fn visit_expr_struct(&mut self, expression: &'ast syn::ExprStruct) {
        if let Some(base) = &expression.rest {
            for field in &expression.fields {
                let syn::Member::Named(name) = &field.member else { continue };
                let code =
                    format!("{{ let base: {} = {}; base.{name} }}", self.text(&expression.path), self.text(&**base));
                let variants = self
                    .at(field, "StructField")
                    .iter()
                    .map(|mutant| (mutant.number, code.clone()))
                    .collect::<Vec<_>>();
                if field.colon_token.is_none() && !variants.is_empty() {
                    let range = self.range(name);
                    self.close(range.start, 0, format!("{name}: "), None);
                }
                self.choice(self.range(&field.expr), variants);
            }
        }
        syn::visit::visit_expr_struct(self, expression);
    }
}
