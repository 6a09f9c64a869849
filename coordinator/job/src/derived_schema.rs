//! JSON schemas derived from the types that read files and tables.

use schemars::generate::SchemaSettings;
use schemars::transform::RecursiveTransform;
use schemars::{JsonSchema, Schema};
use serde_json::{Value, json};

/// Returns the schema of the type that reads a file or a table, in draft 7 of JSON Schema: the one that editors of TOML read.
pub fn from_type<T: JsonSchema>() -> Value {
    let mut settings = SchemaSettings::draft07().with_transform(RecursiveTransform(simplify));
    settings.inline_subschemas = true;
    settings.into_generator().into_root_schema_for::<T>().to_value()
}

/// Removes the null that TOML does not have and defaults that are tables, and lists the words of an enumeration under `enum`.
fn simplify(schema: &mut Schema) {
    let Some(schema) = schema.as_object_mut() else {
        return;
    };
    for key in ["anyOf", "oneOf"] {
        let Some(Value::Array(mut shapes)) = schema.remove(key) else {
            continue;
        };
        shapes.retain(|shape| shape["type"] != "null");
        let words: Option<Vec<&Value>> = shapes.iter().map(|shape| shape.get("const")).collect();
        if let Some(words) = words {
            let words = json!(words);
            schema.extend([("type".to_owned(), json!("string")), ("enum".to_owned(), words)]);
        } else if let [Value::Object(only)] = &mut shapes[..] {
            only.append(schema);
            schema.append(only);
        } else {
            schema.insert(key.to_owned(), shapes.into());
        }
    }
    for key in ["type", "enum"] {
        if let Some(Value::Array(alternatives)) = schema.get_mut(key) {
            alternatives.retain(|value| value != "null" && !value.is_null());
            if let ("type", [only]) = (key, &alternatives[..]) {
                schema[key] = only.clone();
            }
        }
    }
    schema.retain(|key, value| key != "default" || !(value.is_null() || value.is_object()));
}
