//! `reduce`: the files of a reduced model.

use super::{json, number, run, stderr, succeed};

#[test]
fn a_reduced_model_is_read_by_others_as_it_was_made() {
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let arguments =
        ["reduce", "ROBOT", "--below-hz", "3", "--input", "fz", "--output", "az", "--output", "cable:3@0.5:z"];
    fn with<'a>(arguments: &[&'a str], model: &'a str) -> Vec<&'a str> {
        [arguments, &["--matrices", model]].concat()
    }
    let (npz, csv) = (place("my model.npz"), place("a folder"));
    let found = json(&with(&arguments, &npz));
    let n = found["order"].as_u64().unwrap();
    assert!(number(&found["truncation_error"]) <= 1e-3 && number(&found["frequency_error"]) < 1e-4);
    assert!(succeed(&with(&arguments, &csv)).contains(&format!("{n} coordinates: the platform's 6")));
    let mut archive = zip::ZipArchive::new(std::fs::File::open(&npz).unwrap()).unwrap();
    let shapes =
        [("M", [n, n]), ("K", [n, n]), ("B", [n, 1]), ("L", [2, n]), ("ss_A", [2 * n, 2 * n]), ("ss_D", [2, 1])];
    for (name, shape) in shapes {
        let mut bytes = Vec::new();
        std::io::copy(&mut archive.by_name(&format!("{name}.npy")).unwrap(), &mut bytes).unwrap();
        let array = npyz::NpyFile::new(&bytes[..]).unwrap();
        assert_eq!((array.shape(), array.order()), (&shape[..], npyz::Order::Fortran), "{name}");
        let values: Vec<f64> = array.into_vec().unwrap();
        // The CSV files hold equal numbers, row by row.
        let text = std::fs::read_to_string(format!("{csv}/{name}.csv")).unwrap();
        let rows: Vec<Vec<f64>> =
            text.lines().map(|line| line.split(',').map(|x| x.parse().unwrap()).collect()).collect();
        assert_eq!([rows.len() as u64, rows[0].len() as u64], shape, "{name}");
        for (i, row) in rows.iter().enumerate() {
            for (j, value) in row.iter().enumerate() {
                assert_eq!(value.to_bits(), values[j * rows.len() + i].to_bits(), "{name} {i} {j}");
            }
        }
    }
    assert!(archive.by_name("description.json").is_ok());
    // Existing files are never overwritten.
    let refused = run(&with(&arguments, &csv));
    assert_eq!(refused.status.code(), Some(2));
    assert!(stderr(&refused).contains("is not empty"), "{}", stderr(&refused));
    let refused = run(&with(&arguments, &place("model.mat")));
    assert!(stderr(&refused).contains("neither an .npz file nor a folder"), "{}", stderr(&refused));
    let refused = run(&["reduce", "ROBOT", "--below-hz", "3", "--cable-model", "shallow-dynamic"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(stderr(&refused).contains("choose the cable model `catenary-dynamic`"), "{}", stderr(&refused));
}
