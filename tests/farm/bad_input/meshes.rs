//! Wrong surfaces of wheels, through `check` and `run`.

use farm_tests::cylinder::Cylinder;
use farm_tests::job::Job;

use super::{refusal, refused};

const RIM: Cylinder = Cylinder {
    facets: 24,
    radius_m: 0.125,
    width_m: 0.112,
    grousers: 0,
    grouser_height_m: 0.0,
    grouser_thickness_m: 0.0,
};

fn with(file: &str, content: impl Into<Vec<u8>>) -> Job {
    Job::with_mesh(file).beside(file, content)
}

#[test]
fn a_surface_in_other_units_or_about_another_axle_says_so() {
    refused(
        with("wheel.stl", RIM.ascii_stl(1000.0)),
        "wheel.stl: the surface reaches 125 m from the axle, more than 1.5 radius_m = 0.1875 m: metres are expected, were these millimetres?",
    );
    refused(
        with("wheel.stl", RIM.ascii_stl(0.5)),
        "wheel.stl: the surface reaches 0.0625 m from the axle, but radius_m is 0.125 m: metres are expected, and the axle is the y axis",
    );
    // x and y exchanged: the axle lies along x.
    let swapped: String = RIM
        .obj()
        .lines()
        .map(|line| {
            let words: Vec<&str> = line.split(' ').collect();
            match words.as_slice() {
                ["v", x, y, z] => format!("v {y} {x} {z}\n"),
                _ => format!("{line}\n"),
            }
        })
        .collect();
    refused(
        with("wheel.obj", swapped),
        "wheel.obj: the surface is 0.25 m wide along y, more than 1.05 width_m = 0.1176 m: is the axle the y axis through the origin?",
    );
}

#[test]
fn files_that_are_no_surface_name_face_or_line() {
    let binary = RIM.binary_stl();
    refused(
        with("wheel.stl", &binary[..binary.len() - 25]),
        "wheel.stl: neither text nor binary STL: binary STL with this header would have 4884 bytes, not 4859",
    );
    let mut infinite = binary;
    infinite[84 + 50 + 12..][..4].copy_from_slice(&f32::NAN.to_le_bytes());
    refused(
        with("wheel.stl", infinite),
        "wheel.stl: face 2: coordinate NaN m is not finite",
    );
    let message = refusal(&with(
        "wheel.stl",
        RIM.ascii_stl(1.0).replacen("vertex", "vortex", 5),
    ));
    assert!(message.starts_with("wheel.stl: face 1: "), "{message}");
    assert!(message.contains("vortex"), "{message}");
    refused(
        with("wheel.obj", "v 0 0 0\nv 0.1 0 0\nv 0 0 0.1\nf 1 2 4\n"),
        "wheel.obj line 4: face vertex \"4\" is not among the 3 vertices",
    );
    refused(
        with("wheel.obj", "v 0 0 0\nv 0.1 zero 0\nf 1 1 1\n"),
        "wheel.obj line 2: position parse error",
    );
    refused(
        with("wheel.obj", "# empty\n"),
        "wheel.obj: the file has no triangle",
    );
    let message = refusal(&Job::with_mesh("wheel.stl"));
    assert!(message.starts_with("wheel.stl: No such file"), "{message}");
}

#[test]
fn keys_that_do_not_go_with_a_surface_are_refused() {
    refused(
        with("wheel.ply", "ply"),
        "experiment.toml: [wheel.w] mesh = \"wheel.ply\" must end in .stl or .obj",
    );
    for key in ["grouser_count", "grouser_height_m", "grouser_thickness_m"] {
        let job = with("wheel.stl", RIM.binary_stl());
        let (wheel, more) = ("mesh = \"wheel.stl\"", format!("mesh = \"wheel.stl\"\n{key} = 0"));
        refused(
            job.in_experiment(wheel, &more),
            &format!(
                "experiment.toml: [wheel.w] {key} has no place beside mesh = \"wheel.stl\": grousers are part of the surface"
            ),
        );
    }
    refused(
        with("wheel.stl", RIM.binary_stl()),
        "job.toml: wheel w is a surface mesh: quasi_static rolls a smooth cylinder; use kind = \"scm\"",
    );
}
