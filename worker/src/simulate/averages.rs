//! The table of simulated averages in the form of `runs.csv`: one row for each run.

use shared::channel::Channel;
use shared::experiment::{CONDITION_COLUMNS, Experiment, RigColumn, TestRun};
use shared::outcome::Observables;

/// Writes the averages of each run plus its `errors` in the order of the channels, in the form of the experiment's `runs.csv`.
///
/// A value in the table counts as measured, and a measurement needs its noise. Channels without a stated noise are therefore
/// blank, unless the experiment states none at all: then no calibration can use it, and all channels are written.
pub(super) fn averages(
    experiment: &Experiment,
    observables: &Observables,
    errors: &[[f64; 4]],
) -> Result<Vec<u8>, csv::Error> {
    let runs = &experiment.runs;
    let states_sd = |channel: Channel| runs.iter().any(|run| run.sd[channel.index()].is_some());
    let with_sd: Vec<Channel> = Channel::ALL.into_iter().filter(|c| states_sd(*c)).collect();
    let states_none = with_sd.is_empty() && experiment.noise.sd.iter().all(Option::is_none);
    let has_noise = |run: &TestRun, channel: Channel| {
        let c = channel.index();
        states_none || run.sd[c].is_some() || experiment.noise.sd[c].is_some()
    };
    for channel in Channel::ALL {
        if !runs.iter().any(|run| has_noise(run, channel)) {
            let channel = channel.column();
            tracing::info!(channel, "left blank: the experiment states no noise for it");
        }
    }
    let has_order = runs.iter().any(|run| run.order.is_some());
    let has_prepared = runs.iter().any(|run| run.prepared.is_some());
    let mut stated = RigColumn::ALL.to_vec();
    stated.retain(|column| runs.iter().any(|run| column.id(run).is_some()));
    let mut header: Vec<String> = CONDITION_COLUMNS.map(str::to_owned).to_vec();
    header.extend(Channel::ALL.map(|c| c.column().to_owned()));
    header.extend(with_sd.iter().map(|c| format!("{}_sd", c.column())));
    header.extend(has_order.then(|| "order".to_owned()));
    header.extend(has_prepared.then(|| "prepared".to_owned()));
    header.extend(stated.iter().map(|column| column.name().to_owned()));
    header.push("use".into());
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(&header)?;
    for (i, run) in runs.iter().enumerate() {
        let mut row = vec![run.name.clone(), run.wheel.clone(), run.soil.clone()];
        row.extend(
            [run.slip, run.wheel_load_n, run.sled_speed_m_s, run.slip_angle_deg].map(|x| x.to_string()),
        );
        row.push(run.pass.to_string());
        // A channel that an external model lacks is not measured.
        let noisy = |c: Channel| {
            let value = observables.channel(c).get(i).filter(|_| has_noise(run, c))?;
            Some((value + errors[i][c.index()]).to_string())
        };
        let blank_or = |value: Option<String>| value.unwrap_or_default();
        row.extend(Channel::ALL.map(|c| blank_or(noisy(c))));
        row.extend(
            with_sd
                .iter()
                .map(|c| blank_or(run.sd[c.index()].map(|sd| sd.to_string()))),
        );
        row.extend(has_order.then(|| blank_or(run.order.map(|order| order.to_string()))));
        row.extend(has_prepared.then(|| blank_or(run.prepared.clone())));
        row.extend(
            stated
                .iter()
                .map(|column| blank_or(column.id(run).map(str::to_owned))),
        );
        row.push(run.usage.name().to_owned());
        writer.write_record(&row)?;
    }
    writer.into_inner().map_err(|e| e.into_error().into())
}
