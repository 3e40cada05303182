// What the types of toml-eslint-parser name of ESLint, which the page does not have.
declare module "eslint" {
  export namespace SourceCode {
    type VisitorKeys = Record<string, readonly string[]>;
  }
}
