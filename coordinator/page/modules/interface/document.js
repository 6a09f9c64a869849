// What openapi.json says, as this page shows it: operations by tag, schemas in words.

/**
 * @typedef {{ method: string, path: string, id: string, summary: string, description: string, parameters:
 *   JsonParameter[], body: JsonOperation["requestBody"] | null, responses: [string, JsonResponse][] }} Operation
 */

/**
 * The operations of each tag, in the order of the tags.
 * @param {OpenApi} document
 * @returns {{ name: string, description: string, operations: Operation[] }[]}
 */
export function groups(document) {
  const operations = Object.entries(document.paths).flatMap(([path, methods]) =>
    Object.entries(methods).map(([method, says]) => ({
      method: method.toUpperCase(),
      path,
      id: says.operationId,
      tag: says.tags[0],
      summary: says.summary,
      description: says.description,
      parameters: says.parameters ?? [],
      body: says.requestBody ?? null,
      responses: Object.entries(says.responses),
    })),
  );
  return document.tags.map((tag) => ({
    ...tag,
    operations: operations.filter((operation) => operation.tag === tag.name),
  }));
}

/** The name of the schema that a reference leads to. */
const named = (/** @type {string} */ reference) => reference.slice(reference.lastIndexOf("/") + 1);

/**
 * What a schema takes, in words; names of other schemas are parts of their own, so that they can be links.
 * @param {JsonSchema | undefined} schema
 * @returns {(string | { name: string })[]}
 */
export function words(schema) {
  if (!schema) return ["anything"];
  if (schema.$ref) return [{ name: named(schema.$ref) }];
  const several = schema.oneOf ?? schema.anyOf ?? schema.allOf;
  if (several) return several.flatMap((form, k) => [...(k ? [" or "] : []), ...words(form)]);
  if (schema.const !== undefined) return [JSON.stringify(schema.const)];
  if (schema.enum) return [schema.enum.map((value) => JSON.stringify(value)).join(", ")];
  const types = [schema.type ?? "anything"].flat();
  return types.flatMap((type, k) => [...(k ? [" or "] : []), ...ofType(type, schema)]);
}

/** @returns {(string | { name: string })[]} */
function ofType(/** @type {string} */ type, /** @type {JsonSchema} */ schema) {
  if (type === "array") return ["list of ", ...words(schema.items)];
  if (type === "object" && schema.additionalProperties) return ["by name: ", ...words(schema.additionalProperties)];
  if (type === "object" && schema.properties) return [`{ ${Object.keys(schema.properties).join(", ")} }`];
  if (type === "integer") return [schema.minimum === 0 ? "whole number, 0 or more" : "whole number"];
  return [type];
}

/**
 * The line of a shell that asks the same.
 * @param {string} url
 * @param {string | null} token whether one is sent
 */
export const curl = (url, token) => `curl -s ${token ? '-H "Authorization: Bearer $GROUSER_TOKEN" ' : ""}'${url}'`;

/**
 * The path with its parameters.
 * @param {Operation} operation
 * @param {Record<string, string>} values by name
 */
export function filled(operation, values) {
  let path = operation.path;
  const query = new URLSearchParams();
  for (const { name, in: place } of operation.parameters) {
    const value = values[name] ?? "";
    if (place === "path") path = path.replace(`{${name}}`, encodeURIComponent(value));
    else if (value !== "") query.set(name, value);
  }
  return query.size ? `${path}?${query}` : path;
}
