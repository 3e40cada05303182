//! The tests of the crate as a whole, one program for all of them.

mod agreement;
mod boards;
mod brick;
#[path = "designer/main.rs"]
mod designer;
mod draft;
mod endings;
mod felt;
mod fit_command;
mod gallery;
mod handover;
#[path = "kinds/main.rs"]
mod kinds;
#[path = "outputs/main.rs"]
mod outputs;
mod play_command;
mod processes;
mod recording;
mod report;
mod safety;
mod scenario_page;
mod scene_command;
mod score;
mod stream;
mod sweep;
mod untrusted_text;
mod wrong_inputs;
