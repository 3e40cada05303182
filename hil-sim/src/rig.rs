//! The in-process rig: session, ticker and world, tick by tick, on one thread.

use frixel_control::{Active, Board, Order, Sense, Status, StreamBuffer, Ticker};
use frixel_exchange::{TICK_BYTES_MAX, TickBytes, TickInput, TickOutput};
use frixel_layers::{BitmapPool, Header};
use frixel_session::{NextScene, Session, voltage_max_v_rms};
use frixel_wire::fault::Fault;
use frixel_wire::hello::{BoardLimits, notice};

use crate::board_rig::{BoardRig, BoardView, RigError, RigFault, RigTick};
use crate::{Line, Stroke, World, WorldConfig, WorldError, WorldOptions};

/// Capacity of a board's receive buffer beyond the host's credit, for hello requests, which need no credit, and for
/// noise.
const RECEIVE_MARGIN_LEN: usize = 512;
/// Cycles of a late tick, as reported by the board: above the 4,250 available at 40 kHz on the G474.
const LATE_TICK_CYCLES: u32 = 4_300;
/// Name of the rig in messages.
const NAME: &str = "sim";

/// Memory of a simulated board, which a real board has in statics. Boxed, since it is large.
pub struct BoardMemory {
    pool: BitmapPool,
    playing: Active,
    next: NextScene,
    stream: StreamBuffer,
}

impl BoardMemory {
    /// Memory as it is after a reset.
    #[must_use]
    pub fn new() -> Box<Self> {
        let (playing, next) = (Active::new(), NextScene::new());
        Box::new(Self { pool: BitmapPool::new(), playing, next, stream: StreamBuffer::new() })
    }
}

/// A board's input and output at each of its first ticks.
///
/// [`Rig::start_journal`] starts one. Replay its inputs on another board and compare the outputs to check whether both
/// boards behave identically. The inputs stay valid as long as the outputs are equal, since the world would have
/// responded identically.
pub type Journal = Vec<(TickInput, TickOutput)>;

/// Configuration of a [`Rig`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigConfig {
    /// The simulated board.
    pub board: Board,
    /// The world around it.
    pub world: WorldConfig,
    /// Rate of the serial line, in bits a second.
    pub baud: u32,
}

impl Default for RigConfig {
    /// The simulator's own board.
    fn default() -> Self {
        Self::of(Board::SIMULATOR)
    }
}

impl RigConfig {
    /// A rig of a board in [the world that it expects](WorldConfig::of).
    pub fn of(board: Board) -> Self {
        Self { board, world: WorldConfig::of(&board), baud: 2_000_000 }
    }

    /// This rig in the world of `options`. Its own world has to be an ideal one.
    #[must_use]
    pub fn with(self, options: &WorldOptions) -> Self {
        Self { world: self.world.with(options), ..self }
    }

    /// This rig with a board that plays drafts: a tick may take longer than the real board has time for.
    #[must_use]
    pub fn for_drafts(self) -> Self {
        let limits = BoardLimits { tick_cycles_max: u32::MAX, ..self.board.limits };
        Self { board: Board { limits, ..self.board }, ..self }
    }
}

/// A board and its world on one thread, in lockstep and in virtual time.
pub struct Rig<'a> {
    session: Session<'a>,
    ticker: Ticker<'a>,
    status: Status,
    world: World,
    to_board: Line,
    to_host: Line,
    at_host: Vec<u8>,
    host_is_away: bool,
    scene: Option<Header>,
    journal: Option<Journal>,
    tick: u64,
    board: Board,
    /// Memory for further starts, since that of the current start is borrowed.
    spare: core::slice::IterMut<'a, Box<BoardMemory>>,
}

impl<'a> Rig<'a> {
    /// A board after reset, in a world whose finger will perform `stroke`.
    pub fn new(memory: &'a mut BoardMemory, config: &RigConfig, stroke: Stroke, seed: u64) -> Result<Self, WorldError> {
        let tick_hz = config.board.tick_hz;
        let (session, ticker) = started(config.board, memory);
        let mut to_board = Line::new(config.baud, tick_hz)?;
        to_board.limit_queue(usize::from(config.board.limits.receive_window_bytes) + RECEIVE_MARGIN_LEN);
        Ok(Self {
            session,
            status: ticker.status(),
            ticker,
            world: World::new(config.world, stroke, seed)?,
            to_board,
            to_host: Line::new(config.baud, tick_hz)?,
            at_host: Vec::new(),
            host_is_away: false,
            scene: None,
            journal: None,
            tick: 0,
            board: config.board,
            spare: [].iter_mut(),
        })
    }

    /// Adds memory for restarts by [`RigFault::Reset`] or [`RigFault::OptionBytes`], one per restart.
    #[must_use]
    pub fn with_spare_memories(self, memories: &'a mut [Box<BoardMemory>]) -> Self {
        Self { spare: memories.iter_mut(), ..self }
    }

    /// Resets the board, which restarts with `memory`. World and line continue.
    pub fn reset(&mut self, memory: &'a mut BoardMemory) {
        (self.session, self.ticker) = started(self.board, memory);
        self.status = self.ticker.status();
        self.scene = None;
    }

    /// Raises a fault detected by the board itself, such as a late tick.
    pub fn raise(&mut self, fault: Fault, detail: u32) {
        self.ticker.raise(fault, detail);
    }

    /// Ticks since power-on.
    pub fn tick(&self) -> u64 {
        self.tick
    }

    /// Ticks a second.
    pub fn tick_hz(&self) -> u32 {
        self.board.tick_hz
    }

    /// The world, to inject faults and to move the finger.
    pub fn world_mut(&mut self) -> &mut World {
        &mut self.world
    }

    /// The line from the host to the board, to inject faults.
    pub fn line_to_board_mut(&mut self) -> &mut Line {
        &mut self.to_board
    }

    /// The last committed scene; `None` before one was committed.
    pub fn scene(&self) -> Option<&Header> {
        self.scene.as_ref()
    }

    /// Numbers of complete frames that the board received, and of bad frames that it skipped.
    pub fn frame_counts(&self) -> (u32, u32) {
        self.session.frame_counts()
    }

    /// Sends bytes from the host. Bytes beyond the host's credit and a margin for messages without credit are lost, as
    /// on a board with a full receive buffer. Thus no byte arrives later than from a host that respects its credit.
    pub fn send(&mut self, bytes: &[u8]) {
        self.to_board.send(bytes);
    }

    /// Sets whether the host has stopped reading. Meanwhile the line accepts no bytes from the board, like a port with
    /// a full buffer, and the board's output waits in its transmit queue.
    pub fn set_host_away(&mut self, is_away: bool) {
        self.host_is_away = is_away;
    }

    /// Appends the bytes that have arrived at the host to `bytes`.
    pub fn receive(&mut self, bytes: &mut Vec<u8>) {
        bytes.append(&mut self.at_host);
    }

    /// Whether any bytes have arrived at the host.
    pub fn has_received(&self) -> bool {
        !self.at_host.is_empty()
    }

    /// Starts a journal of all input and output of the board. Call this before the first tick, so that the journal can
    /// be replayed on another board.
    pub fn start_journal(&mut self) {
        self.journal = Some(Journal::new());
    }

    /// Ends the journal and returns it; `None` without a started journal.
    pub fn take_journal(&mut self) -> Option<Journal> {
        self.journal.take()
    }

    /// Advances one tick.
    pub fn step(&mut self) -> RigTick<Status> {
        let RigTick { tick, drive, felt, .. } = self.advance();
        RigTick { tick, drive, felt, status: self.status }
    }

    /// As [`Self::step`], for a watcher of any rig.
    fn advance(&mut self) -> RigTick {
        let arrived = self.to_board.tick();
        let received =
            self.journal.as_ref().map(|_| arrived.iter().copied().take(TICK_BYTES_MAX).collect::<TickBytes>());
        if !arrived.is_empty() {
            self.session.receive(arrived, &self.status);
        }
        let touch = self.world.touch();
        if let Some(touch) = touch {
            self.session.touch(touch, self.status.telemetry.tick.wrapping_add(1));
        }
        self.deliver_orders();
        let sense = self.sense();
        let drive = self.ticker.tick(&sense);
        let felt = self.world.apply(drive);
        self.status = self.ticker.status();
        self.session.poll(&self.status);
        let (room, mut bytes) = (self.room(), [0; TICK_BYTES_MAX]);
        let sent = self.transmit(bytes.get_mut(..usize::from(room)).unwrap_or_default());
        self.tick += 1;
        if let (Some(journal), Some(received)) = (&mut self.journal, received) {
            let (tick, sent) = (self.tick as u32, sent.iter().copied().collect());
            journal.push((TickInput { tick, received, room, touch, sense }, TickOutput { tick, drive, sent }));
        }
        RigTick { tick: self.tick, drive, felt, status: BoardView::Status(self.status) }
    }

    /// The board's input. The simulated person releases the arm switch and presses it again on request of the board.
    fn sense(&self) -> Sense {
        let sense = self.world.sense();
        let is_held = !self.ticker.waits_for_release() || self.world.is_switch_welded();
        Sense { arm_switch: sense.arm_switch && is_held, ..sense }
    }

    /// Passes the session's next order to the ticker, one before each tick.
    fn deliver_orders(&mut self) {
        let Some(order) = self.session.next_order() else { return };
        let is_new_scene = matches!(order, Order::Load(_));
        if let Some(spare) = self.ticker.apply(order) {
            self.session.take_back(spare);
        }
        if is_new_scene {
            self.put_scenes_finger_on();
        }
    }

    /// Loads the scene's finger into the world.
    fn put_scenes_finger_on(&mut self) {
        self.scene = self.session.scene_header().copied();
        let Some(header) = self.scene else { return };
        // The knots of an empirical law depend on the board's largest voltage.
        let Ok(voltage_max_v_rms) = voltage_max_v_rms(&header, &self.board) else { return };
        if let Ok(law) = (Header { voltage_max_v_rms, ..header }).friction_law() {
            self.world.set_finger(law, header.carrier(&self.board.limits, self.board.tick_hz).half_period_ticks);
        }
    }

    /// Number of bytes that the line accepts now. Its queue is limited like a port's; further bytes wait on the board,
    /// which omits telemetry if too many do.
    fn room(&self) -> u8 {
        if self.host_is_away { 0 } else { TICK_BYTES_MAX.saturating_sub(self.to_host.queued()) as u8 }
    }

    /// Moves bytes from the board's transmit queue to the line, as long as `bytes` has room, and returns them.
    fn transmit<'b>(&mut self, bytes: &'b mut [u8]) -> &'b [u8] {
        let count = self.session.transmit(bytes);
        let sent = bytes.get(..count).unwrap_or_default();
        if !sent.is_empty() {
            self.to_host.send(sent);
        }
        self.at_host.extend_from_slice(self.to_host.tick());
        sent
    }
}

/// A freshly started board.
fn started(board: Board, memory: &mut BoardMemory) -> (Session<'_>, Ticker<'_>) {
    let BoardMemory { pool, playing, next, stream } = memory;
    let mut ticker = Ticker::new(&board, pool, playing);
    ticker.attach_stream(stream);
    let mut session = Session::new(board, pool, next);
    session.attach_stream(stream);
    (session, ticker)
}

impl BoardRig for Rig<'_> {
    fn name(&self) -> &'static str {
        NAME
    }

    fn board(&self) -> &Board {
        &self.board
    }

    fn tick(&self) -> u64 {
        self.tick
    }

    fn sees_board(&self) -> bool {
        true
    }

    fn send(&mut self, bytes: &[u8]) -> Result<(), RigError> {
        self.to_board.send(bytes);
        Ok(())
    }

    fn run(
        &mut self,
        until_tick: u64,
        received: &mut Vec<u8>,
        watch: &mut dyn FnMut(&RigTick),
    ) -> Result<(), RigError> {
        while !self.has_received() && self.tick < until_tick {
            watch(&self.advance());
        }
        self.receive(received);
        Ok(())
    }

    fn cause(&mut self, fault: RigFault, ticks: u64) -> Result<(), RigError> {
        match fault {
            RigFault::World(fault) => self.world.cause(fault, ticks)?,
            RigFault::Reset | RigFault::OptionBytes => {
                let reason = "its board has no memory left for another start";
                let memory = self.spare.next().ok_or(RigError::FaultUnavailable { rig: NAME, reason })?;
                if fault == RigFault::OptionBytes {
                    // The board finds them at its next start.
                    self.board.notices |= notice::OPTION_BYTES;
                }
                self.reset(memory);
            }
            RigFault::LateTick => self.raise(Fault::Deadline, LATE_TICK_CYCLES),
            RigFault::WrapSoon { ticks } => {
                self.ticker.set_tick(0_u32.wrapping_sub(ticks));
                self.status = self.ticker.status();
            }
        }
        Ok(())
    }

    fn start_stroke(&mut self) {
        self.world.start_stroke();
    }
}
