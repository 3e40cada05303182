// What page and <frixel-scene> use of others; build.mjs joins it into chart-vendor.js.

export { default as uPlot } from "uplot";
export { default as uPlotStyle } from "uplot/dist/uPlot.min.css";
