//! The tests of the crate as a whole, one program for all of them.

mod agreement;
mod boards;
mod corpus;
#[path = "designer/main.rs"]
mod designer;
mod felt;
mod fit_command;
mod gallery;
mod handover;
#[path = "kinds/main.rs"]
mod kinds;
#[path = "outputs/main.rs"]
mod outputs;
mod processes;
mod recording;
mod report;
mod safety;
mod scenario_page;
mod score;
mod stream;
mod sweep;
