// The types of studio-vendor.js: those of the packages that it is made from.

export * from "./entry.js";
export type { Completion, CompletionContext, CompletionResult } from "@codemirror/autocomplete";
export type { Diagnostic } from "@codemirror/lint";
export type { ChangeSet, ChangeSpec, Extension, StateCommand, Text } from "@codemirror/state";
export type { UnzipFileInfo } from "fflate";
