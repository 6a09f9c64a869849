//! Our models by UM-Bridge: what comes back is what the model itself computes, to the bit.

use std::io::{BufRead, BufReader};
use std::process::{Child, Stdio};

use farm_tests::job::Job;
use farm_tests::programs;
use farm_tests::service::Service;
use farm_tests::text::same;

/// `worker serve --umbridge` on a free port; killed when dropped.
struct Served {
    child: Child,
    url: String,
}

impl Served {
    fn start() -> Served {
        let mut command = programs::worker(["serve", "--umbridge", "--port", "0"]);
        let mut child = command
            .stdout(Stdio::piped())
            .spawn()
            .expect("the program starts");
        let mut url = String::new();
        let stdout = child.stdout.take().expect("a pipe");
        BufReader::new(stdout).read_line(&mut url).expect("a line");
        let url = url.trim().to_owned();
        Served { child, url }
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.child.kill();
        self.child.wait().expect("a child can be waited for");
    }
}

/// Returns the posterior of a job, of which the parameters of the model stand in this order.
fn posterior(job: &Job, allowed: Option<&str>) -> String {
    let service = Service::start(&[]);
    let id = service.submit(job);
    let _worker = match allowed {
        None => service.worker("worker", 2),
        Some(url) => service.worker_of("worker", 2, url),
    };
    service.wait_for(id, "finished");
    service.posterior_csv(id)
}

#[test]
fn quasi_static_served_and_called_gives_the_bits_of_quasi_static() {
    let served = Served::start();
    let ours = Job::small();
    let theirs = Job::small().in_job(
        "kind = \"quasi_static\"\n",
        &format!(
            "kind = \"umbridge\"\nurl = \"{}\"\nmodel = \"quasi_static\"\nversion = \"1\"\n\
             inputs = [\"slip\", \"wheel_load_n\", \"sled_speed_m_s\", \"slip_angle_deg\", \"radius_m\", \"width_m\"]\n\
             parameters = [\"log10_p_ref\", \"kappa\", \"n\", \"friction_angle_deg\", \"cohesion_pa\", \
             \"shear_velocity_m_s\", \"gamma_exponent\"]\n\
             outputs = [\"drawbar_pull_n\", \"torque_n_m\", \"sinkage_m\", \"lateral_force_n\"]\n",
            served.url
        ),
    );
    // The rig's radius is not among the inputs, so that it must equal the radius of the rim.
    let own_radius = |job: Job| job.in_job("wheel_radius_m = { uniform = [0.125, 0.155] }\n", "");
    same(
        &posterior(&own_radius(theirs), Some(&served.url)),
        &posterior(&own_radius(ours), None),
    );
}
