//! Wheels given as surfaces: from file to vertices, through text where the file is binary.

use farm_tests::cylinder::Cylinder;
use farm_tests::job::Job;
use farm_tests::service::Service;
use serde_json::json;
use shared::experiment::{Experiment, WheelMesh};

const WHEEL: Cylinder = Cylinder {
    facets: 60,
    radius_m: 0.125,
    width_m: 0.112,
    grousers: 12,
    grouser_height_m: 0.009,
    grouser_thickness_m: 0.002,
};

/// Returns the small job with a mesh beside its wheel.
fn with(file: &str, content: impl Into<Vec<u8>>) -> Job {
    Job::with_mesh(file).beside(file, content)
}

/// Returns the mesh of a job that is written to disk and read back; its text, too.
fn read(file: &str, job: &Job) -> (WheelMesh, String) {
    let folder = tempfile::tempdir().expect("a folder");
    job.write(folder.path());
    let files = Experiment::read_files(&folder.path().join("experiment.toml")).expect("files");
    let experiment = Experiment::parse("experiment.toml", &files).expect("an experiment");
    let mesh = experiment.wheels["w"].mesh.clone().expect("a mesh");
    (mesh, files.files[file].clone())
}

#[test]
fn ascii_and_binary_stl_and_obj_are_the_same_surface() {
    let (ascii, _) = read("wheel.stl", &with("wheel.stl", WHEEL.ascii_stl(1.0)));
    let (binary, text) = read("wheel.STL", &with("wheel.STL", WHEEL.binary_stl()));
    let (obj, _) = read("wheel.obj", &with("wheel.obj", WHEEL.obj()));
    assert_eq!(ascii, binary);
    assert!(text.starts_with("solid wheel\nfacet normal 0 0 0\n") && text.ends_with("endsolid wheel\n"));
    let expected = WHEEL.triangles();
    assert_eq!(ascii.triangles.len(), expected.len());
    assert_eq!(obj.triangles.len(), expected.len());
    for (t, corners) in expected.iter().enumerate() {
        for (c, corner) in corners.iter().enumerate() {
            let vertex = |mesh: &WheelMesh| mesh.vertices_m[mesh.triangles[t][c] as usize];
            assert_eq!(
                vertex(&obj).map(f64::to_bits),
                corner.map(|x| (x + 0.0).to_bits())
            );
            assert_eq!(
                vertex(&ascii).map(|x| (x as f32).to_bits()),
                corner.map(|x| (x as f32).to_bits()),
                "triangle {t}"
            );
        }
    }
    // Two corners of the outline on each side and the two ends of the axle: STL's triangles share them again.
    assert_eq!(ascii.vertices_m.len(), expected.len() / 4 * 2 + 2);
}

#[test]
fn grousers_reach_beyond_the_nominal_radius() {
    let (mesh, _) = read("wheel.stl", &with("wheel.stl", WHEEL.binary_stl()));
    let reach = mesh.reach_m();
    assert!(reach > 0.1339 && reach < 0.1341, "{reach}");
    assert!((mesh.width_m() - 0.112).abs() < 1e-8);
    let (smooth, _) = read(
        "wheel.stl",
        &with("wheel.stl", Cylinder::smooth(48, 0.125, 0.112).ascii_stl(1.0)),
    );
    assert!((smooth.reach_m() - 0.125).abs() < 1e-8 && smooth.triangles.len() == 4 * 48);
}

#[test]
fn a_mesh_goes_through_json_and_none_leaves_no_trace() {
    let (mesh, _) = read("wheel.stl", &with("wheel.stl", WHEEL.binary_stl()));
    let text = serde_json::to_string(&mesh).unwrap();
    assert_eq!(serde_json::from_str::<WheelMesh>(&text).unwrap(), mesh);
    let folder = tempfile::tempdir().unwrap();
    Job::small().write(folder.path());
    let files = Experiment::read_files(&folder.path().join("experiment.toml")).unwrap();
    let experiment = Experiment::parse("experiment.toml", &files).unwrap();
    let wheel = serde_json::to_value(&experiment.wheels["w"]).unwrap();
    assert_eq!(wheel.get("mesh"), None, "{wheel}");
}

#[test]
fn the_service_takes_a_mesh_as_text_and_a_smooth_cylinder_refuses_to_roll_it() {
    let service = Service::start(&[]);
    let job = with("wheel.stl", WHEEL.ascii_stl(1.0));
    let created = service.client.post("/v1/experiments", &job.experiment_json());
    assert_eq!(created.status, 201);
    let refused = service.client.post(
        "/v1/calibrations",
        &json!({"experiment": created.json()["id"], "toml": job.job}),
    );
    assert_eq!(refused.status, 422);
    assert_eq!(
        refused.json()["error"]["message"],
        "job.toml: wheel w is a surface mesh: quasi_static rolls a smooth cylinder; use kind = \"scm\""
    );
    let millimetres = with("wheel.stl", WHEEL.ascii_stl(1000.0));
    let refused = service
        .client
        .post("/v1/experiments", &millimetres.experiment_json());
    assert_eq!(refused.status, 422);
}
