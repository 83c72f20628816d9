//! What a run says that it drew, and how long it took, is that of captured frames.

use std::path::Path;

use rain_plugins::report::PassName;
use rain_plugins::scenario::Session;
use test_support::gpu;
use test_support::shots::{Plan, View, steady};

/// A capture of rain after so many frames.
fn captured(warm_up_frames: u32) -> Session {
    let view = View::new([0.0, 1.7, 9.0], [0.0, 1.7, 0.0]);
    let mut plan = Plan::new(steady(50.0, [0.0; 3]), 4.0, &[view]);
    plan.scenario.warm_up_frames = warm_up_frames;
    plan.scenario.outputs.size = [256, 144];
    plan.scenario.outputs.masks.clear();
    let mut session = plan.session(Path::new("."), |_| {});
    session.capture(4.0).expect("a capture");
    session
}

#[test]
fn frames_before_a_capture_are_drawn_and_neither_counted_nor_timed() {
    if !gpu::available() {
        return;
    }
    let (short, long) = (captured(1), captured(3));
    for (session, drawn) in [(&short, 2), (&long, 4)] {
        assert_eq!(session.passes().passes[&PassName::Rainfall].recorded, drawn);
        let drops = session.measured().counts().drops;
        assert!(drops.maximum > 100, "{drops:?}");
        assert!(
            (drops.median - drops.maximum as f64).abs() < 0.25,
            "one frame: {drops:?}"
        );
        let times = session.measured();
        assert!(
            times
                .median_of("render/rain_rainfall/elapsed_cpu")
                .is_some_and(|ms| ms > 0.0)
        );
    }
    assert_eq!(short.measured().counts().drops, long.measured().counts().drops);
}
