//! Session and ticker in this process, with the inputs of the emulated board at the same ticks.
//!
//! A line, a main loop and a queue lie between the host and the Pico's tick, so the tick at which a report is received,
//! and the one at which its track is followed, depend on how busy the board is. Both are known: the emulator shows
//! every order that the tick takes, and a track begins at the tick after the status that the main loop had when it
//! received the report.

use std::collections::VecDeque;

use frixel_control::{Active, Board, Order, Sense, Status, Ticker, Track};
use frixel_hil_sim::emulated::{AppliedOrder, Watched};
use frixel_hil_sim::{Stroke, World, WorldConfig};
use frixel_layers::BitmapPool;
use frixel_session::{NextScene, Session};

use super::bench::BOARD;

/// Largest number of ticks between a report and its track: the one in which the main loop has it, and those that the
/// queue holds.
const LAG_TICKS_MAX: u32 = 40;
/// Steps of a commit, at most.
const COMMIT_STEPS_MAX: u32 = 200;
/// Numbers of kinds of orders.
const SIGN_OF_LIFE: u32 = 0;
const TRACK: u32 = 1;

/// The board.
pub(super) struct Twin {
    session: Session<'static>,
    ticker: Ticker<'static>,
    /// Frames that the emulated board has received, and this one has not yet.
    frames: VecDeque<Vec<u8>>,
    /// The status after each tick, and first the one before any tick.
    statuses: Vec<Status>,
    /// Computes the monitor's voltage.
    world: World,
}

impl Twin {
    /// Replays the inputs of another board on a freshly started one, and returns its codes at every tick.
    pub(super) fn codes(watched: &Watched) -> Vec<i16> {
        Self::new(&watched.bytes).run(&watched.orders, watched.ticks)
    }

    fn new(bytes: &[u8]) -> Self {
        let pool: &BitmapPool = Box::leak(Box::new(BitmapPool::new()));
        let (playing, next) = (Box::leak(Box::new(Active::new())), Box::leak(Box::new(NextScene::new())));
        let ticker = Ticker::new(&BOARD, pool, playing);
        let nowhere = Stroke::through(&[(0.0, None)]).unwrap();
        Self {
            session: Session::new(Board { touch_from_host: true, ..BOARD }, pool, next),
            statuses: vec![ticker.status()],
            ticker,
            frames: bytes.split_inclusive(|byte| *byte == 0).map(<[u8]>::to_vec).collect(),
            world: World::new(WorldConfig::of(&BOARD), nowhere, 1).unwrap(),
        }
    }

    fn run(&mut self, orders: &[AppliedOrder], ticks: u32) -> Vec<i16> {
        let mut orders = orders.iter().peekable();
        let code = |tick| {
            if let Some(order) = orders.next_if(|order| order.tick == tick) {
                self.take(order);
            }
            // A person who lets go of the switch when the board waits for it.
            let arm_switch = !self.ticker.waits_for_release();
            let drive = self.ticker.tick(&Sense { arm_switch, ..self.world.sense() });
            self.world.apply(drive);
            self.statuses.push(self.ticker.status());
            drive.dac_code.bits()
        };
        (1..=ticks).map(code).collect()
    }

    /// Passes the session's next order to the ticker. It must equal the order that the emulated board's tick took.
    fn take(&mut self, expected: &AppliedOrder) {
        if expected.words[0] == SIGN_OF_LIFE {
            self.ticker.apply(Order::SignOfLife);
            return;
        }
        let heard = if expected.words[0] == TRACK { from_tick(expected) - 1 } else { expected.tick - 1 };
        let status = self.statuses[heard as usize];
        let order = self.next_order(&status);
        if let Order::Track(track) = &order {
            assert_eq!(words(track), sorted(&expected.words[1..]), "the track at tick {}", expected.tick);
        }
        assert_eq!(kind(&order), expected.words[0], "the order at tick {}", expected.tick);
        if let Some(spare) = self.ticker.apply(order) {
            self.session.take_back(spare);
        }
    }

    /// The session's next order that is not a sign of life, after as many frames as it takes.
    fn next_order(&mut self, status: &Status) -> Order<'static> {
        loop {
            for _ in 0..COMMIT_STEPS_MAX {
                self.session.poll(status);
                // Discard the answers.
                while self.session.transmit(&mut [0; 256]) > 0 {}
                match self.session.next_order() {
                    None | Some(Order::SignOfLife) => {}
                    Some(order) => return order,
                }
            }
            let Some(frame) = self.frames.pop_front() else { panic!("the board has received no frame for an order") };
            self.session.receive(&frame, status);
        }
    }
}

/// The tick at which the track of an order begins. Its offset in memory is the compiler's choice; every other word is
/// the bits of a fraction, a small number, or a tick that is farther away.
fn from_tick(order: &AppliedOrder) -> u32 {
    let lag = |word: &u32| order.tick.wrapping_sub(*word);
    let near: Vec<u32> = order.words[1..].iter().copied().filter(|word| lag(word) < LAG_TICKS_MAX).collect();
    assert!(!near.is_empty() && near.iter().all(|word| *word == near[0]), "a track that begins in {near:?}: {order:?}");
    near[0]
}

/// The words of a track, in the order of their values.
fn words(track: &Track) -> Vec<u32> {
    let [place_m, path, half_path, velocity, half_velocity] = [
        track.place_m,
        track.path_velocity_m_per_s,
        track.path_half_acceleration_m_per_s2,
        track.velocity_m_per_s,
        track.half_acceleration_m_per_s2,
    ]
    .map(|pair| pair.map(f32::to_bits));
    let ramp = [track.ramp.from_tick, track.ramp.gain.to_bits(), track.ramp.slope_per_tick.to_bits()];
    let ticks = [track.contact, track.from_tick, track.until_tick];
    sorted(&[&place_m[..], &path, &half_path, &velocity, &half_velocity, &ramp, &ticks].concat())
}

fn sorted(words: &[u32]) -> Vec<u32> {
    let mut words = words.to_vec();
    words.sort_unstable();
    words
}

fn kind(order: &Order) -> u32 {
    match order {
        Order::SignOfLife => SIGN_OF_LIFE,
        Order::Track(_) => TRACK,
        Order::Lift => 2,
        Order::Load(_) => 3,
        Order::Unload => 4,
        Order::SetLayer { .. } => 5,
        Order::Arm => 6,
        Order::Disarm => 7,
        Order::Play => 8,
        Order::Stop => 9,
        Order::ClearFault => 10,
        Order::StartStream(_) => 11,
        Order::EndStream { .. } => 12,
    }
}
