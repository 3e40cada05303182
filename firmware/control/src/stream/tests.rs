use proptest::prelude::*;

use super::*;

const TICK_HZ: u32 = 40_000;
const FADE_TICKS: u32 = 400;

/// Both ends of a buffer.
struct Ends<'a> {
    intake: StreamIntake<'a>,
    player: Player<'a>,
}

impl<'a> Ends<'a> {
    fn new(buffer: &'a StreamBuffer) -> Self {
        let mut player = Player::new(1.0 / TICK_HZ as f32);
        player.attach(buffer);
        Self { intake: StreamIntake::new(buffer), player }
    }

    /// Both ends, with a stream.
    fn started(buffer: &'a StreamBuffer, sample_hz: u32, start_level: u16) -> Self {
        let mut ends = Self::new(buffer);
        ends.start(sample_hz, start_level);
        ends
    }

    fn start(&mut self, sample_hz: u32, start_level: u16) {
        let start = self.intake.start(sample_hz, TICK_HZ, start_level);
        self.player.start(start);
    }

    fn take(&mut self, first_index: u32, samples: &[u16]) {
        let bytes: Vec<[u8; 2]> = samples.iter().map(|sample| sample.to_le_bytes()).collect();
        self.intake.take(first_index, &bytes);
    }

    fn end(&mut self) {
        let last = self.intake.end().unwrap();
        self.player.end(last);
    }

    fn advance(&mut self) -> StreamSample {
        self.player.advance(&mut StreamSample::default());
        self.player.now()
    }

    fn run(&mut self, ticks: u32) -> Vec<StreamSample> {
        (0..ticks).map(|_| self.advance()).collect()
    }
}

/// A buffer full of samples that were played, `before_wrap` samples before its positions start again from zero.
fn buffer_before_wrap(before_wrap: u32) -> StreamBuffer {
    let buffer = StreamBuffer::new();
    let position = 0_u32.wrapping_sub(before_wrap);
    buffer.end.store(position, Ordering::Relaxed);
    buffer.next.store(position, Ordering::Relaxed);
    for back in 1..=LEN {
        buffer.put(position.wrapping_sub(back), u16::MAX);
    }
    buffer
}

/// Samples that differ from each other within a buffer's length.
fn sample(index: u32) -> u16 {
    (index.wrapping_mul(40_503) >> 3) as u16
}

fn samples(from: u32, count: u32) -> Vec<u16> {
    (from..from + count).map(sample).collect()
}

/// Straight lines between the samples, in f64, `ticks` ticks after the first sample.
fn reference(sample_hz: u32, ticks: u32) -> f64 {
    let place = f64::from(ticks) * f64::from(sample_hz) / f64::from(TICK_HZ);
    let before = place.floor();
    let value = |index: f64| f64::from(sample(index as u32)) / 65_535.0;
    value(before) + (place - before) * (value(before + 1.0) - value(before))
}

proptest! {
    /// The player interpolates linearly between samples, at any sample rate and across the wrap of positions.
    #[test]
    fn a_steady_stream_is_interpolated_linearly(sample_hz in 200..=TICK_HZ, before_wrap in 0..3000_u32) {
        let buffer = buffer_before_wrap(before_wrap);
        let mut ends = Ends::started(&buffer, sample_hz, 300);
        let (mut sent, mut played) = (0, 0);
        while played < 4_000 {
            let (next, room) = ends.intake.progress().unwrap();
            prop_assert_eq!(next, sent);
            let count = u32::from(room).min(90);
            if count > 0 {
                ends.take(sent, &samples(sent, count));
                sent += count;
            }
            let now = ends.advance();
            if ends.player.phase == Phase::Playing {
                // The first tick takes the first sample, the second takes the next one, and the third is between
                // them.
                let expected = reference(sample_hz, played.max(1) - 1);
                // A step is 2^-31 of a sample too short at most, 4,000 times.
                let error = f64::from(now.value) - expected;
                prop_assert!(error.abs() < 1e-5, "tick {}: {:?} is not {}", played, now, expected);
                played += 1;
                let weight = (played as f32 / FADE_TICKS as f32).min(1.0);
                prop_assert!((now.weight - weight).abs() < 1e-4, "tick {}: {:?}", played, now);
            }
        }
        prop_assert_eq!(ends.player.counts(), (0, 0));
    }

    /// Frames that come twice or in another order play as if they had come once and in order.
    #[test]
    fn repeats_and_reordering_do_no_harm(
        order in Just((0..11_u32).collect::<Vec<_>>()).prop_shuffle(),
        again in prop::collection::vec(0..11_u32, 0..8),
        sample_hz in 2_000..=TICK_HZ,
    ) {
        let play = |order: &[u32]| {
            let buffer = StreamBuffer::new();
            let mut ends = Ends::started(&buffer, sample_hz, 800);
            for frame in order {
                ends.take(90 * frame, &samples(90 * frame, 90));
            }
            ends.end();
            (ends.run(5_000), ends.player.counts())
        };
        let in_order: Vec<u32> = (0..11).collect();
        let mixed: Vec<u32> = order.into_iter().chain(again).collect();
        prop_assert_eq!(play(&mixed), play(&in_order));
    }

    /// Under any sequence of calls, values and weights stay within bounds, weights jump only to zero by `stop`, and a
    /// stream never plays a sample of another.
    #[test]
    fn any_order_of_calls_is_safe_and_never_stale(
        calls in prop::collection::vec((0..12_u8, any::<u32>(), 0..120_u32), 1..120),
        before_wrap in 0..2_000_u32,
    ) {
        let buffer = buffer_before_wrap(before_wrap);
        let mut ends = Ends::new(&buffer);
        let (mut stream, mut shown) = (0_u16, None);
        let mut before = StreamSample::default();
        for (call, index, count) in calls {
            match call {
                0 => {
                    stream += 1;
                    shown = None;
                    ends.start(1 + index % TICK_HZ, 1 + (index % 800) as u16);
                }
                1 if ends.intake.first.is_some() => ends.end(),
                2 => { ends.player.stop(&mut StreamSample::default()); before.weight = 0.0; }
                3 => ends.take(index, &vec![100 * stream; count as usize]),
                4..=8 => ends.take(index % 1_500, &vec![100 * stream; count as usize]),
                _ => for _ in 0..index % 1_000 {
                    let now = ends.advance();
                    prop_assert!((0.0..=1.0).contains(&now.value) && (0.0..=1.0).contains(&now.weight), "{:?}", now);
                    let step = (now.weight - before.weight).abs();
                    prop_assert!(step <= 1.01 / FADE_TICKS as f32, "{:?} {:?}", before, now);
                    // After it has faded out, it belongs to this stream.
                    if now.weight == 0.0 { shown = Some(stream); }
                    if shown == Some(stream) && now.weight > 0.0 {
                        prop_assert_eq!((now.value * 65_535.0).round() as u16, 100 * stream);
                    }
                    before = now;
                },
            }
            if let Some((next, room)) = ends.intake.progress() {
                prop_assert!(u32::from(room) <= LEN, "{} {}", next, room);
            }
        }
    }
}

#[test]
fn a_pause_of_the_host_is_one_underrun_that_fades_and_resumes() {
    let buffer = StreamBuffer::new();
    let mut ends = Ends::started(&buffer, TICK_HZ, 500);
    ends.take(0, &samples(0, 500));
    let played = ends.run(500);
    assert_eq!(played[499].weight.to_bits(), 1.0_f32.to_bits());
    let last = f32::from(sample(499)) * VALUE_PER_SAMPLE;
    // Sample 499 is the last one that has arrived.
    let dry = ends.run(1_000);
    assert_eq!(ends.player.counts(), (1, 0));
    assert!(ends.player.is_dry());
    for (tick, now) in (1..).zip(&dry) {
        let weight = (1.0 - tick as f32 / FADE_TICKS as f32).max(0.0);
        assert!((now.weight - weight).abs() < 1e-4, "tick {tick}: {now:?}");
        assert!(now.weight <= 0.0 || (now.value - last).abs() < 1e-6, "tick {tick}: {now:?}");
    }
    assert_eq!(dry[FADE_TICKS as usize].weight.to_bits(), 0);

    ends.take(500, &samples(500, 499));
    ends.run(1_000);
    assert!(ends.player.is_dry(), "one sample below the start level");
    ends.take(999, &samples(999, 1));
    let back = ends.run(4);
    assert!(!ends.player.is_dry());
    for (index, (tick, now)) in [500, 500, 501, 502].into_iter().zip((1..).zip(&back)) {
        let expected = f32::from(sample(index)) * VALUE_PER_SAMPLE;
        assert!((now.value - expected).abs() < 1e-6, "sample {index}: {now:?}");
        let weight = tick as f32 / FADE_TICKS as f32;
        assert!((now.weight - weight).abs() < 1e-5, "sample {index}: {now:?}");
    }
    assert_eq!(ends.player.counts(), (1, 0));
}

#[test]
fn a_gap_is_counted_once_and_does_not_stop_time() {
    let buffer = StreamBuffer::new();
    let mut ends = Ends::started(&buffer, TICK_HZ, 800);
    ends.take(0, &samples(0, 450));
    ends.take(540, &samples(540, 450));
    ends.run(450);
    assert_eq!(ends.player.counts(), (0, 0));
    let held = f32::from(sample(449)) * VALUE_PER_SAMPLE;
    let in_gap = ends.run(90);
    assert_eq!(ends.player.counts(), (0, 1));
    assert!(in_gap.windows(2).all(|pair| pair[1].weight < pair[0].weight), "it fades");
    assert!(in_gap.iter().all(|now| (now.value - held).abs() < 1e-6));
    let after = ends.run(2);
    assert!((after[1].value - f32::from(sample(540)) * VALUE_PER_SAMPLE).abs() < 1e-6, "{after:?}");
    assert!(after[1].weight > in_gap[89].weight);
    assert_eq!(ends.player.counts(), (0, 1));
}

#[test]
fn the_end_is_no_underrun_and_needs_no_start_level() {
    for count in [1, 50, 200] {
        let buffer = StreamBuffer::new();
        let mut ends = Ends::started(&buffer, TICK_HZ, 100);
        ends.take(0, &samples(0, count));
        ends.run(10);
        assert_eq!(ends.player.is_dry(), count < 100);
        ends.end();
        ends.take(count, &samples(count, 50));
        let rest: Vec<StreamSample> = (0..1_000)
            .map(|_| {
                let now = ends.advance();
                assert!(!ends.player.is_dry(), "a stream that ends does not run dry");
                now
            })
            .collect();
        assert!(rest.iter().any(|now| now.weight > 0.0), "samples that arrived are played");
        assert_eq!(rest.last().map(|now| now.weight.to_bits()), Some(0));
        assert_eq!((ends.player.phase, ends.player.counts()), (Phase::Over, (0, 0)));
        assert_eq!(ends.intake.progress(), None);
    }
}

#[test]
fn samples_beyond_the_buffer_or_already_played_are_dropped() {
    let buffer = StreamBuffer::new();
    let mut ends = Ends::started(&buffer, TICK_HZ, 100);
    assert_eq!(ends.intake.progress(), Some((0, 1024)));
    ends.take(0, &samples(0, 1_000));
    ends.take(1_000, &samples(1_000, 90));
    assert_eq!(ends.intake.progress(), Some((1_024, 0)));
    let played = ends.run(200);
    assert_eq!(ends.intake.progress(), Some((1_024, 200)));
    ends.take(100, &vec![0; 200]);
    assert_eq!(ends.intake.progress(), Some((1_024, 200)), "repeats take no room");
    let expected = f32::from(sample(198)) * VALUE_PER_SAMPLE;
    assert!((played[199].value - expected).abs() < 1e-6);
    // Of the 200 zeros, those before the player's next position were dropped, the others took effect.
    assert!(ends.run(50)[2..].iter().all(|now| now.value.to_bits() == 0));
    assert!((ends.run(52)[51].value - f32::from(sample(300)) * VALUE_PER_SAMPLE).abs() < 1e-6);
}

#[test]
fn another_stream_plays_from_its_first_sample_and_not_before() {
    let buffer = StreamBuffer::new();
    let mut ends = Ends::started(&buffer, TICK_HZ, 100);
    ends.take(0, &samples(0, 600));
    ends.run(500);
    ends.end();
    // The session is ahead: the ticker has not received the order for the new stream yet.
    let start = ends.intake.start(TICK_HZ, TICK_HZ, 50);
    assert_eq!(ends.intake.progress(), Some((0, 1_024)), "the rest of the old stream takes no room");
    ends.take(0, &[7_000; 200]);
    let old = ends.run(150);
    let last = f32::from(sample(599)) * VALUE_PER_SAMPLE;
    assert!(old[110..].iter().all(|now| (now.value - last).abs() < 1e-6), "the old one ends where it ends");
    let before = old[149];
    assert!(before.weight > 0.5);
    ends.player.start(start);
    assert_eq!(ends.player.now(), before, "it fades from where it was");
    let new = ends.run(10);
    assert!((new[9].value - 7_000.0 * VALUE_PER_SAMPLE).abs() < 1e-6);
    assert_eq!(ends.player.counts(), (0, 0));
}

#[test]
fn a_stream_without_a_sample_is_over_when_it_ends() {
    let buffer = StreamBuffer::new();
    let mut ends = Ends::started(&buffer, TICK_HZ, 100);
    ends.run(10);
    assert!(ends.player.is_dry());
    ends.end();
    ends.run(1);
    assert!(!ends.player.is_dry());
}

#[test]
fn the_last_sample_is_held_whatever_the_rate() {
    for sample_hz in [300, 7_001, 30_000, TICK_HZ] {
        let buffer = StreamBuffer::new();
        let mut ends = Ends::started(&buffer, sample_hz, 20);
        ends.take(0, &samples(0, 20));
        let last = f32::from(sample(19)) * VALUE_PER_SAMPLE;
        let played = ends.run(30 * TICK_HZ / sample_hz);
        let dry = played.len() - 5 * (TICK_HZ / sample_hz) as usize;
        assert_eq!(ends.player.counts(), (1, 0));
        assert!(played[dry..].iter().all(|now| (now.value - last).abs() < 1e-6), "{sample_hz}");
    }
}

/// Half of the first frames are lost: the stream starts when the samples that arrived reach its start level.
#[test]
fn holes_do_not_count_towards_the_start_level() {
    for before_wrap in [0, 50, 2_000] {
        let buffer = buffer_before_wrap(before_wrap);
        let mut ends = Ends::started(&buffer, 8_000, 200);
        // 180 samples of 450: two frames of five.
        ends.take(90, &samples(90, 90));
        ends.take(360, &samples(360, 90));
        ends.take(360, &samples(360, 90));
        ends.run(10);
        assert_eq!(ends.player.phase, Phase::Filling, "180 samples are less than 200");
        // A late frame fills a hole.
        ends.take(0, &samples(0, 90));
        ends.run(1);
        assert_eq!(ends.player.phase, Phase::Playing, "270 samples are more than 200");
        ends.take(180, &samples(180, 180));
        ends.run(5 * 400);
        assert_eq!(ends.player.counts(), (0, 0));
        ends.run(5 * 60);
        assert_eq!((ends.player.phase, ends.player.counts()), (Phase::Filling, (1, 0)));
    }
}

/// Skipped holes no longer count when the stream waits again.
#[test]
fn skipped_holes_do_not_delay_the_stream_again() {
    let buffer = StreamBuffer::new();
    let mut ends = Ends::started(&buffer, 8_000, 90);
    ends.take(0, &samples(0, 90));
    ends.take(180, &samples(180, 90));
    ends.run(5 * 300);
    assert_eq!((ends.player.phase, ends.player.counts()), (Phase::Filling, (1, 1)));
    ends.take(270, &samples(270, 89));
    ends.run(10);
    assert_eq!(ends.player.phase, Phase::Filling);
    ends.take(359, &samples(359, 1));
    ends.run(1);
    assert_eq!(ends.player.phase, Phase::Playing);
}

/// The holes leave no room for the start level: the stream starts when its buffer takes no further frame.
#[test]
fn a_buffer_without_room_starts_the_stream() {
    let buffer = StreamBuffer::new();
    let mut ends = Ends::started(&buffer, 8_000, 800);
    ends.take(900, &samples(900, 90));
    ends.run(1);
    assert_eq!(ends.player.phase, Phase::Playing);
}
