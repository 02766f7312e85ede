//! A network as plain arrays, which [`super::import`] reads again.

use serde_json::{Value, json};

use tofsim::network::file::Training;
use tofsim::network::float::Float;

/// Weights for raw counts and metres, and where they come from, as JSON.
pub fn json(float: &Float, training: &Training) -> Value {
    let rows: Vec<Value> = float.w1.iter().map(|row| row.to_vec().into()).collect();
    json!({
        "training": training,
        "IW": rows,
        "LW": float.w2,
        "b": [json!(float.b1), json!([float.b2])],
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quantize::import;
    use tofsim::network::Network;

    #[test]
    fn what_is_written_is_read_to_the_bit() {
        let network = Network::builtin("uniform-16").unwrap().unwrap();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("network.json");
        std::fs::write(&path, json(&network.twin(), &network.training).to_string()).unwrap();
        assert!(import::read(&path, 256).unwrap() == network.twin());
    }
}
