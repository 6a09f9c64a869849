// The types of what is vendored here: preact with its hooks, and htm bound to it.
export { Component, createContext, h, render } from "preact";
export * from "preact/hooks";
import type { VNode } from "preact";
export declare function html(strings: TemplateStringsArray, ...values: unknown[]): VNode;
