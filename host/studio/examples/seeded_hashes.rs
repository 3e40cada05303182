//! Prints the hash of one seeded stroke over each gallery scene, computed natively, as one JSON object.
//!
//! The browser tests compare them with what the page computes: `cargo run -p frixel-studio --example seeded_hashes`.

use std::error::Error;
use std::path::Path;

use frixel_studio::seeded_hash;

#[path = "../tests/gallery/mod.rs"]
mod gallery;

/// Seed and duration of each play; the browser tests use the same.
const SEED: u64 = 7;
const DURATION_MS: u32 = 500;

fn main() -> Result<(), Box<dyn Error>> {
    let mut hashes = serde_json::Map::new();
    for mut request in gallery::requests(Path::new(env!("CARGO_MANIFEST_DIR")))? {
        (request.numbers.seed, request.numbers.duration_ms) = (SEED, DURATION_MS);
        let hash = seeded_hash(&request).map_err(|error| format!("{}: {error}", request.entry))?;
        hashes.insert(request.entry, format!("{hash:016x}").into());
    }
    println!("{}", serde_json::Value::Object(hashes));
    Ok(())
}
