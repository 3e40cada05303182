//! A board of plain values, whose tick runs when a test calls it.

use std::cell::{Cell, RefCell};
use std::rc::Rc;

use embedded_io::{ErrorKind, ErrorType, Read, ReadReady, Write, WriteReady};
use frixel_board::hardware::{Dac, DacFrames, Hardware, Late, Monitor, Period, Watchdog};
use frixel_board::start::Parts;
use frixel_board::tick::{Tick, TickShared};
use frixel_drivers::amplifier::KickedEnable;
use frixel_drivers::pin::{DirectPin, ReadLevel, SetLevel};
use frixel_testkit::IdealMonitor;
use frixel_wire::dac_code::DacCode;

use super::firmware::{BOARD, monitor};

pub(crate) const PERIOD_CYCLES: u32 = 4_250;
pub(crate) const DEADLINE_CYCLES: u32 = 3_700;

/// A call of a part of the board.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Event {
    Sent(DacCode),
    Kicked,
    Disabled,
    Prepared,
    Checked,
    Fed,
    DebuggerMayStop(bool),
    TickStarted,
    WatchdogStarted,
}

/// The wires of the board, which its parts share with the test.
pub(crate) struct Wires {
    pub(crate) events: RefCell<Vec<Event>>,
    /// Cycles since the start of the period when the tick reads the timer.
    pub(crate) cycles: Cell<u32>,
    /// The next period begins before the tick ends.
    pub(crate) overruns: Cell<bool>,
    /// Calls of `has_begun` in this tick.
    asked: Cell<u32>,
    pub(crate) is_late: Cell<bool>,
    pub(crate) ready: Cell<bool>,
    pub(crate) switch_closed: Cell<bool>,
    pub(crate) light: Cell<bool>,
    /// Result of reading the DAC's configuration back.
    pub(crate) dac: Cell<Result<(), u32>>,
    /// Result of the serial port's calls.
    pub(crate) port: Cell<Result<(), ErrorKind>>,
    pub(crate) received: RefCell<Vec<u8>>,
    pub(crate) transmitted: RefCell<Vec<u8>>,
    monitor: RefCell<IdealMonitor>,
    code: Cell<DacCode>,
    shared: Cell<Option<&'static TickShared>>,
    /// Ticks that had begun their work when the monitor was read last.
    pub(crate) ticks_at_reading: Cell<u32>,
}

/// A board with its amplifier on and its switch released, on time.
pub(crate) fn wires() -> Rc<Wires> {
    Rc::new(Wires {
        events: RefCell::default(),
        cycles: Cell::new(1_000),
        overruns: Cell::new(false),
        asked: Cell::new(0),
        is_late: Cell::new(false),
        ready: Cell::new(true),
        switch_closed: Cell::new(false),
        light: Cell::new(false),
        dac: Cell::new(Ok(())),
        port: Cell::new(Ok(())),
        received: RefCell::default(),
        transmitted: RefCell::default(),
        monitor: RefCell::new(monitor()),
        code: Cell::new(DacCode::ZERO),
        shared: Cell::new(None),
        ticks_at_reading: Cell::new(0),
    })
}

impl Wires {
    pub(crate) fn say(&self, event: Event) {
        self.events.borrow_mut().push(event);
    }

    /// The last reading of the monitor, V.
    pub(crate) fn monitor_v(&self) -> f32 {
        self.monitor.borrow().voltage_v()
    }

    /// The events since the last call.
    pub(crate) fn take(&self) -> Vec<Event> {
        self.events.take()
    }
}

/// Any part of the board.
pub(crate) struct Part(pub(crate) Rc<Wires>);

/// A pin that reads one of the wires.
pub(crate) struct Input(Rc<Wires>, fn(&Wires) -> bool);

/// The board's parts.
pub(crate) struct Fake;

thread_local! {
    /// The tick of this thread's test, which runs while the main loop waits for it.
    static TICK: RefCell<Option<Tick<Fake>>> = const { RefCell::new(None) };
}

/// Stores the tick for [`run_tick`].
pub(crate) fn start(tick: Tick<Fake>) {
    TICK.set(Some(tick));
}

/// Runs a tick.
pub(crate) fn run_tick() {
    TICK.with_borrow_mut(|tick| {
        let tick = tick.as_mut().unwrap();
        tick.monitor.0.asked.set(0);
        tick.run();
    });
}

impl Hardware for Fake {
    const TICK_HZ: u32 = BOARD.tick_hz;

    type Period = Part;
    type Frames = Part;
    type Dac = Part;
    type Enable = Part;
    type Ready = DirectPin<Input>;
    type Monitor = Part;
    type Switch = DirectPin<Input>;
    type Light = DirectPin<Part>;
    type Serial = Part;
    type Watchdog = Part;

    fn wait_for_tick() {
        run_tick();
    }
}

/// The parts of a board with these wires.
pub(crate) fn parts(wires: &Rc<Wires>, shared: &'static TickShared) -> Parts<Fake> {
    let part = || Part(Rc::clone(wires));
    wires.shared.set(Some(shared));
    Parts {
        period: part(),
        frames: part(),
        dac: part(),
        enable: part(),
        ready: DirectPin(Input(Rc::clone(wires), |wires| wires.ready.get())),
        monitor: part(),
        switch: DirectPin(Input(Rc::clone(wires), |wires| wires.switch_closed.get())),
        light: DirectPin(part()),
        serial: Some(part()),
    }
}

impl Period for Part {
    const PERIOD_CYCLES: u32 = PERIOD_CYCLES;
    const DEADLINE_CYCLES: u32 = DEADLINE_CYCLES;

    fn cycles(&self) -> u32 {
        self.0.cycles.get()
    }

    fn has_begun(&mut self) -> bool {
        self.0.asked.set(self.0.asked.get() + 1);
        self.0.asked.get() == 1 || self.0.overruns.get()
    }
}

impl DacFrames for Part {
    fn send(&mut self, code: DacCode) -> Result<(), Late> {
        if self.0.is_late.get() {
            return Err(Late);
        }
        self.0.say(Event::Sent(code));
        self.0.code.set(code);
        Ok(())
    }
}

impl KickedEnable for Part {
    fn kick(&mut self) {
        self.0.say(Event::Kicked);
    }

    fn disable(&mut self) {
        self.0.say(Event::Disabled);
        self.0.code.set(DacCode::ZERO);
    }
}

impl Monitor for Part {
    fn monitor_v(&mut self) -> f32 {
        self.0.ticks_at_reading.set(self.0.shared.get().unwrap().count());
        let mut monitor = self.0.monitor.borrow_mut();
        monitor.follow(self.0.code.get());
        monitor.voltage_v()
    }
}

impl Dac for Part {
    fn prepare(&mut self) -> Result<(), u32> {
        self.0.say(Event::Prepared);
        self.0.dac.get()
    }

    fn check(&mut self) -> Result<(), u32> {
        self.0.say(Event::Checked);
        self.0.dac.get()
    }
}

impl Watchdog for Part {
    fn feed(&mut self) {
        self.0.say(Event::Fed);
    }

    fn let_debugger_stop_it(&mut self, may_stop: bool) {
        self.0.say(Event::DebuggerMayStop(may_stop));
    }
}

impl SetLevel for Part {
    fn set(&self, high: bool) {
        self.0.light.set(high);
    }
}

impl ReadLevel for Input {
    fn is_high(&self) -> bool {
        self.1(&self.0)
    }
}

impl ErrorType for Part {
    type Error = ErrorKind;
}

impl ReadReady for Part {
    fn read_ready(&mut self) -> Result<bool, ErrorKind> {
        self.0.port.get()?;
        Ok(!self.0.received.borrow().is_empty())
    }
}

impl Read for Part {
    fn read(&mut self, bytes: &mut [u8]) -> Result<usize, ErrorKind> {
        self.0.port.get()?;
        let mut received = self.0.received.borrow_mut();
        let len = received.len().min(bytes.len());
        for (to, from) in bytes.iter_mut().zip(received.drain(..len)) {
            *to = from;
        }
        Ok(len)
    }
}

impl WriteReady for Part {
    fn write_ready(&mut self) -> Result<bool, ErrorKind> {
        self.0.port.get()?;
        Ok(true)
    }
}

impl Write for Part {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, ErrorKind> {
        self.0.port.get()?;
        self.0.transmitted.borrow_mut().extend(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> Result<(), ErrorKind> {
        Ok(())
    }
}
