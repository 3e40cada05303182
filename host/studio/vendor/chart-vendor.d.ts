// The types of chart-vendor.js: those of the package that it is made from.

export * from "./chart_entry.js";
