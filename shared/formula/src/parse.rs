//! Turn the text of a formula into operations.
//!
//! ```text
//! sum     = product { ("+" | "-") product }
//! product = power { ("*" | "/") power }
//! power   = "-" power | atom [ "^" power ]
//! atom    = number | name | function "(" sum { "," sum } ")" | "(" sum ")"
//!         | "if" "(" sum comparison sum "," sum "," sum ")"
//! ```

use std::collections::BTreeMap;

use crate::graph::{Binary, Graph, Id, Node, Unary};
use crate::token::{Mistake, Token, Tokens};
use crate::variable::{Variable, Variables};
use crate::word::unknown_word;

/// Most characters of a formula.
pub(crate) const LONGEST: usize = 2000;
/// Deepest nesting of parentheses, signs and functions.
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

/// The names that mean an operation or a constant everywhere.
pub(crate) fn reserved() -> impl Iterator<Item = &'static str> {
    let functions = UNARY.iter().map(|f| f.0).chain(BINARY.iter().map(|f| f.0));
    functions.chain(["if", "pi"])
}

/// What names mean in a formula.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scope<'a> {
    pub(crate) variables: Variables,
    /// Names of the parameters, in their order.
    pub(crate) parameters: &'a [String],
    /// The operations that stand behind the names of definitions.
    pub(crate) definitions: &'a BTreeMap<String, Id>,
    /// Where the formula stands, for messages: `in pressure`.
    pub(crate) place: &'a str,
}

/// Reads a formula into a graph; gives the operation of its result.
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
            Err(parser.wrong("a comparison stands only in if(condition, then, else)"))
        }
        found => Err(parser.wrong(format!("expected an operator or the end, found {found}"))),
    }
}

struct Parser<'a, 'b> {
    tokens: Tokens<'a>,
    /// The next word, and where it stands.
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

    fn add(&mut self, node: Node) -> Result<Id, Mistake> {
        let too_many = format!("an effect must have at most {} operations", Graph::MOST);
        self.graph
            .add(node)
            .ok_or_else(|| Mistake::new(self.at, too_many))
    }

    fn sum(&mut self) -> Result<Id, Mistake> {
        let mut left = self.product()?;
        loop {
            let operation = match self.token {
                Token::Sign("+") => Binary::Add,
                Token::Sign("-") => Binary::Subtract,
                _ => return Ok(left),
            };
            self.advance()?;
            let right = self.product()?;
            left = self.add(Node::Binary(operation, left, right))?;
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
            self.advance()?;
            let right = self.power()?;
            left = self.add(Node::Binary(operation, left, right))?;
        }
    }

    fn power(&mut self) -> Result<Id, Mistake> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(self.wrong(format!("nested deeper than {DEEPEST} levels")));
        }
        let result = if self.token == Token::Sign("-") {
            self.advance()?;
            let positive = self.power()?;
            self.add(Node::Unary(Unary::Negate, positive))?
        } else {
            let base = self.atom()?;
            if self.token == Token::Sign("^") {
                self.advance()?;
                let exponent = self.power()?;
                self.add(Node::Binary(Binary::Power, base, exponent))?
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
                self.advance()?;
                self.add(Node::Number(value.to_bits()))
            }
            Token::Name(name) => self.name(name),
            Token::Sign("(") => {
                self.advance()?;
                let inside = self.sum()?;
                self.expect(")")?;
                Ok(inside)
            }
            found => Err(self.wrong(format!("expected a number, a name or \"(\", found {found}"))),
        }
    }

    fn expect(&mut self, sign: &str) -> Result<(), Mistake> {
        if self.token == Token::Sign(sign) {
            return self.advance();
        }
        Err(self.wrong(format!("expected \"{sign}\", found {}", self.token)))
    }

    fn name(&mut self, name: &str) -> Result<Id, Mistake> {
        let at = self.at;
        self.advance()?;
        let called = self.token == Token::Sign("(");
        if let Some((_, operation)) = UNARY.iter().find(|f| f.0 == name && called) {
            self.advance()?;
            let argument = self.sum()?;
            self.expect(")")?;
            return self.add(Node::Unary(*operation, argument));
        }
        if let Some((_, operation)) = BINARY.iter().find(|f| f.0 == name && called) {
            self.advance()?;
            let first = self.sum()?;
            self.expect(",")?;
            let second = self.sum()?;
            self.expect(")")?;
            return self.add(Node::Binary(*operation, first, second));
        }
        if name == "if" && called {
            return self.choice();
        }
        let mistake = |message: String| Err(Mistake::new(at, message));
        if reserved().any(|word| word == name && word != "pi") {
            return mistake(format!("{name} needs its arguments in parentheses"));
        }
        if called {
            let known = UNARY.iter().map(|f| f.0).chain(BINARY.iter().map(|f| f.0));
            let known: Vec<&str> = known.chain(["if"]).collect();
            return mistake(match self.known(name) {
                true => format!("{name} is no function; write * to multiply"),
                false => format!("unknown function \"{name}\"; there are {}", known.join(", ")),
            });
        }
        if name == "pi" {
            return self.add(Node::Number(core::f64::consts::PI.to_bits()));
        }
        if let Some(&id) = self.scope.definitions.get(name) {
            return Ok(id);
        }
        if let Some(place) = self.scope.parameters.iter().position(|p| p == name) {
            return self.add(Node::Parameter(place as u8));
        }
        match Variable::ALL.into_iter().find(|v| v.name() == name) {
            Some(variable) if self.scope.variables.contains(variable) => self.add(Node::Variable(variable)),
            Some(_) => mistake(format!(
                "{name} is not known {}; expected one of {}",
                self.scope.place,
                self.names().join(", ")
            )),
            None => mistake(unknown_word("name", name, self.names())),
        }
    }

    fn known(&self, name: &str) -> bool {
        self.scope.definitions.contains_key(name)
            || self.scope.parameters.iter().any(|p| p == name)
            || Variable::ALL.iter().any(|v| v.name() == name)
    }

    /// What a name may be.
    fn names(&self) -> Vec<&str> {
        let scope = self.scope;
        let own = scope.parameters.iter().chain(scope.definitions.keys());
        let mut names: Vec<&str> = own.map(String::as_str).collect();
        names.extend(scope.variables.iter().map(|variable| variable.name()));
        names
    }

    /// `(left < right, then, else)`
    fn choice(&mut self) -> Result<Id, Mistake> {
        self.advance()?;
        let left = self.sum()?;
        let Token::Sign(sign @ ("<" | "<=" | ">" | ">=" | "==" | "!=")) = self.token else {
            let message = format!(
                "expected a comparison (<, <=, >, >=, ==, !=), found {}",
                self.token
            );
            return Err(self.wrong(message));
        };
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
        let condition = self.add(condition)?;
        self.expect(",")?;
        let then = self.sum()?;
        self.expect(",")?;
        let otherwise = self.sum()?;
        self.expect(")")?;
        self.add(Node::If(condition, then, otherwise))
    }
}
