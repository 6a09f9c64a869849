//! Parser from the text of a formula to operations.
//!
//! ```text
//! sum     = product { ("+" | "-") product }
//! product = power { ("*" | "/") power }
//! power   = "-" power | atom [ "^" power ]
//! atom    = number | name | function "(" sum { "," sum } ")" | "(" sum ")"
//!         | "if" "(" sum comparison sum "," sum "," sum ")"
//! ```

use std::collections::BTreeMap;

use crate::hook::Hook;
use crate::syntax::dimension::unit_of;
use crate::syntax::graph::{Binary, Graph, Id, Node, Unary};
use crate::syntax::token::{Mistake, Token, Tokens};
use crate::unit::Unit;
use crate::variable::{Variable, Variables};
use crate::word::unknown_word;

/// The maximum number of characters of a formula.
pub(crate) const LONGEST: usize = 2000;
/// The maximum nesting of parentheses, signs and functions.
const DEEPEST: u32 = 50;

const UNARY: [(&str, Unary); 8] = [
    ("exp", Unary::Exp),
    ("log", Unary::Log),
    ("sqrt", Unary::Sqrt),
    ("tanh", Unary::Tanh),
    ("abs", Unary::Abs),
    ("sin", Unary::Sin),
    ("cos", Unary::Cos),
    ("tan", Unary::Tan),
];

const BINARY: [(&str, Binary); 3] = [("min", Binary::Min), ("max", Binary::Max), ("pow", Binary::Power)];

/// Returns the names that mean an operation or a constant in every formula.
pub(crate) fn reserved() -> impl Iterator<Item = &'static str> {
    let functions = UNARY.iter().map(|f| f.0).chain(BINARY.iter().map(|f| f.0));
    functions.chain(["if", "pi"])
}

/// The meaning of names in a formula.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scope<'a> {
    pub(crate) variables: Variables,
    /// Names and units of the parameters, in order.
    pub(crate) parameters: &'a [(String, Unit)],
    pub(crate) definitions: &'a BTreeMap<String, Definition>,
    /// The key of the formula, for messages: `pressure`.
    pub(crate) place: &'a str,
}

#[derive(Debug, Clone, Copy)]
pub(crate) struct Definition {
    pub(crate) result: Id,
    /// The variables that it uses.
    pub(crate) uses: Variables,
}

/// Parses a formula into a graph; returns the operation of its result.
pub(crate) fn parse(text: &str, scope: &Scope, graph: &mut Graph) -> Result<Id, Mistake> {
    let length = text.chars().count();
    if length > LONGEST {
        let message = format!("a formula of {length} characters must have at most {LONGEST}");
        return Err(Mistake::new(LONGEST, message));
    }
    let mut parser = Parser {
        tokens: Tokens::new(text),
        token: Token::End,
        at: 0,
        depth: 0,
        scope,
        graph,
    };
    parser.advance()?;
    let result = parser.sum()?;
    match parser.token {
        Token::End => Ok(result),
        Token::Sign("<" | "<=" | ">" | ">=" | "==" | "!=") => {
            Err(parser.wrong("a comparison is allowed only in if(condition, then, else)"))
        }
        token => {
            let hint = match token {
                Token::Number(_) | Token::Name(_) | Token::Sign("(") => "; write * to multiply",
                Token::Sign(",") => "; use a point for decimals; a comma only separates arguments",
                Token::Sign(")") => "; there is no open parenthesis",
                _ => "",
            };
            Err(parser.wrong(format!("expected an operator or the end, found {token}{hint}")))
        }
    }
}

struct Parser<'a, 'b> {
    tokens: Tokens<'a>,
    /// The next token, and its place.
    token: Token<'a>,
    at: usize,
    depth: u32,
    scope: &'b Scope<'b>,
    graph: &'b mut Graph,
}

impl Parser<'_, '_> {
    fn advance(&mut self) -> Result<(), Mistake> {
        self.token = self.tokens.take()?;
        self.at = self.tokens.place();
        Ok(())
    }

    fn wrong(&self, message: impl Into<String>) -> Mistake {
        Mistake::new(self.at, message)
    }

    /// Adds an operation whose sign or name stands at a place.
    fn add(&mut self, at: usize, node: Node) -> Result<Id, Mistake> {
        let parameter = |place: u8| self.scope.parameters[usize::from(place)].1;
        let unit = unit_of(self.graph, node, parameter).map_err(|e| Mistake::new(at, e.to_string()))?;
        self.graph.add(node, unit).ok_or_else(|| {
            let max = Graph::MAX_OPERATIONS;
            Mistake::new(
                at,
                format!("an effect must have at most {max} different operations"),
            )
        })
    }

    fn sum(&mut self) -> Result<Id, Mistake> {
        let mut left = self.product()?;
        loop {
            let operation = match self.token {
                Token::Sign("+") => Binary::Add,
                Token::Sign("-") => Binary::Subtract,
                _ => return Ok(left),
            };
            let at = self.at;
            self.advance()?;
            let right = self.product()?;
            left = self.add(at, Node::Binary(operation, left, right))?;
        }
    }

    fn product(&mut self) -> Result<Id, Mistake> {
        let mut left = self.power()?;
        loop {
            let operation = match self.token {
                Token::Sign("*") => Binary::Multiply,
                Token::Sign("/") => Binary::Divide,
                _ => return Ok(left),
            };
            let at = self.at;
            self.advance()?;
            let right = self.power()?;
            left = self.add(at, Node::Binary(operation, left, right))?;
        }
    }

    fn power(&mut self) -> Result<Id, Mistake> {
        self.depth += 1;
        if self.depth > DEEPEST {
            let message = format!("parentheses, signs and powers must be nested at most {DEEPEST} deep");
            return Err(self.wrong(message));
        }
        let mut at = self.at;
        let result = if self.token == Token::Sign("-") {
            self.advance()?;
            let positive = self.power()?;
            self.add(at, Node::Unary(Unary::Negate, positive))?
        } else {
            let base = self.atom()?;
            if self.token == Token::Sign("^") {
                at = self.at;
                self.advance()?;
                let exponent = self.power()?;
                self.add(at, Node::Binary(Binary::Power, base, exponent))?
            } else {
                base
            }
        };
        self.depth -= 1;
        Ok(result)
    }

    fn atom(&mut self) -> Result<Id, Mistake> {
        match self.token {
            Token::Number(value) => {
                let at = self.at;
                self.advance()?;
                self.add(at, Node::Number(value.to_bits()))
            }
            Token::Name(name) => self.name(name),
            Token::Sign("(") => {
                self.advance()?;
                let inside = self.sum()?;
                self.expect(")", "to close \"(\"")?;
                Ok(inside)
            }
            token => {
                let hint = match token {
                    Token::Sign("*") => "; a power is written with ^",
                    _ => "",
                };
                let message = format!("expected a number, a name or \"(\", found {token}{hint}");
                Err(self.wrong(message))
            }
        }
    }

    /// Takes a sign that must come next; `why` is for the message.
    fn expect(&mut self, sign: &str, why: &str) -> Result<(), Mistake> {
        if self.token == Token::Sign(sign) {
            return self.advance();
        }
        Err(self.wrong(format!("expected \"{sign}\" {why}, found {}", self.token)))
    }

    fn name(&mut self, name: &str) -> Result<Id, Mistake> {
        let at = self.at;
        self.advance()?;
        let called = self.token == Token::Sign("(");
        if let Some((_, operation)) = UNARY.iter().find(|f| f.0 == name && called) {
            self.advance()?;
            let argument = self.sum()?;
            self.expect(")", &format!("after the argument of {name}"))?;
            return self.add(at, Node::Unary(*operation, argument));
        }
        if let Some((_, operation)) = BINARY.iter().find(|f| f.0 == name && called) {
            self.advance()?;
            let first = self.sum()?;
            self.expect(",", &format!("and a second argument of {name}"))?;
            let second = self.sum()?;
            self.expect(")", &format!("after both arguments of {name}"))?;
            return self.add(at, Node::Binary(*operation, first, second));
        }
        if name == "if" && called {
            return self.choice(at);
        }
        let mistake = |message: String| Err(Mistake::new(at, message));
        if reserved().any(|word| word == name && word != "pi") {
            return mistake(format!("{name} needs its arguments in parentheses"));
        }
        if called {
            let functions = UNARY.iter().map(|f| f.0).chain(BINARY.iter().map(|f| f.0));
            let functions: Vec<&str> = functions.chain(["if"]).collect();
            return mistake(match self.is_declared(name) {
                true => format!("{name} is not a function; write * to multiply"),
                false => format!("unknown function \"{name}\"; there are {}", functions.join(", ")),
            });
        }
        if name == "pi" {
            return self.add(at, Node::Number(core::f64::consts::PI.to_bits()));
        }
        if let Some(definition) = self.scope.definitions.get(name) {
            let hidden = definition
                .uses
                .iter()
                .find(|&v| !self.scope.variables.contains(v));
            return match hidden {
                None => Ok(definition.result),
                Some(variable) => mistake(format!(
                    "definition {name} cannot be used here: {}",
                    self.hidden(variable)
                )),
            };
        }
        if let Some(place) = self.scope.parameters.iter().position(|(p, _)| p == name) {
            return self.add(at, Node::Parameter(place as u8));
        }
        match Variable::ALL.into_iter().find(|v| v.name() == name) {
            Some(variable) if self.scope.variables.contains(variable) => {
                self.add(at, Node::Variable(variable))
            }
            Some(variable) => mistake(self.hidden(variable)),
            None => mistake(unknown_word("name", name, self.names())),
        }
    }

    /// Returns the message that a variable is not visible here, with the hooks that see it.
    fn hidden(&self, variable: Variable) -> String {
        let hooks = Hook::ALL.iter().filter(|hook| hook.sees().contains(variable));
        let hooks: Vec<&str> = hooks.map(|hook| hook.name()).collect();
        format!(
            "{} is not seen by {}, only by {}; known here are {}",
            variable.name(),
            self.scope.place,
            hooks.join(", "),
            self.names().join(", ")
        )
    }

    fn is_declared(&self, name: &str) -> bool {
        self.scope.definitions.contains_key(name)
            || self.scope.parameters.iter().any(|(p, _)| p == name)
            || Variable::ALL.iter().any(|v| v.name() == name)
    }

    /// Returns the names that are visible.
    fn names(&self) -> Vec<&str> {
        let scope = self.scope;
        let declared = scope
            .parameters
            .iter()
            .map(|(p, _)| p)
            .chain(scope.definitions.keys());
        let mut names: Vec<&str> = declared.map(String::as_str).collect();
        names.extend(scope.variables.iter().map(|variable| variable.name()));
        names
    }

    /// Parses `(left < right, then, else)` of an `if` at a place.
    fn choice(&mut self, at: usize) -> Result<Id, Mistake> {
        self.advance()?;
        let left = self.sum()?;
        let Token::Sign(sign @ ("<" | "<=" | ">" | ">=" | "==" | "!=")) = self.token else {
            let message = format!(
                "expected a comparison (<, <=, >, >=, == or !=) as the condition of if, found {}",
                self.token
            );
            return Err(self.wrong(message));
        };
        let at_sign = self.at;
        self.advance()?;
        let right = self.sum()?;
        let condition = match sign {
            "<" => Node::Binary(Binary::Less, left, right),
            "<=" => Node::Binary(Binary::LessOrEqual, left, right),
            ">" => Node::Binary(Binary::Less, right, left),
            ">=" => Node::Binary(Binary::LessOrEqual, right, left),
            "==" => Node::Binary(Binary::Equal, left, right),
            _ => Node::Binary(Binary::Unequal, left, right),
        };
        let condition = self.add(at_sign, condition)?;
        self.expect(",", "after the condition of if")?;
        let then = self.sum()?;
        self.expect(",", "and the value of if where its condition does not hold")?;
        let otherwise = self.sum()?;
        self.expect(")", "after the values of if")?;
        self.add(at, Node::If(condition, then, otherwise))
    }
}
