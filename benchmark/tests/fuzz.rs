//! Some inputs of the bench `fuzz`: every reader refuses in one line that names the file, and no reader panics.

use benchmark::damaged_input::corpus::Corpus;
use benchmark::damaged_input::tally::Tally;

#[test]
fn damaged_inputs_are_read_or_refused_in_a_line_that_names_the_file() {
    let corpus = Corpus::read().expect("the workspace has jobs");
    let tally = Tally::new(&corpus, 1, 0..20_000);
    assert_eq!(
        tally.broken,
        [],
        "cargo bench -p benchmark --bench fuzz -- one 1 NUMBER"
    );
    // Every reader accepts some inputs and refuses others.
    assert_eq!(tally.readers.len(), 7);
    for (name, reader) in &tally.readers {
        assert!(
            (1..reader.inputs).contains(&reader.accepted),
            "{name}: {reader:?}"
        );
    }
}
