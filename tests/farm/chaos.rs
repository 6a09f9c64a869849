//! A hundred events of the bench `chaos`.

use farm_tests::chaos::{faults, run};

#[test]
fn a_hundred_faults_change_no_bit_and_lose_nothing() {
    let (tally, broken) = run(100, 3, |_| ());
    assert!(broken.is_none(), "{}\n{tally}", broken.unwrap_or_default());
    for fault in faults() {
        assert!(
            tally.events.contains_key(fault),
            "{fault:?} never occurred\n{tally}"
        );
    }
    assert_eq!(tally.compared.len(), 3, "{tally}");
    assert!(tally.pauses.is_empty(), "{tally}");
}
