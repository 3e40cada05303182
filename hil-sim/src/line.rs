//! One direction of a serial line, in virtual time.

use std::collections::VecDeque;

use crate::error::OutOfRange;

/// Start bit, eight data bits, stop bit.
const BITS_PER_BYTE: u64 = 10;

/// One direction of a serial line: a byte takes ten bit times, in virtual ticks.
///
/// Time is counted in integers, so the rate is exact for every pair of baud rate and tick rate. The transmit queue is
/// unlimited unless [`limit_queue`](Self::limit_queue) is called; [`queued`](Self::queued) returns its length.
///
/// ```
/// use frixel_hil_sim::Line;
///
/// let mut line = Line::new(2_000_000, 40_000)?;
/// line.send(b"twelve bytes");
/// // Two million bits a second are five bytes in each of 40,000 ticks.
/// assert_eq!(line.tick(), b"twelv");
/// assert_eq!(line.tick(), b"e byt");
/// assert_eq!(line.tick(), b"es");
/// assert_eq!(line.tick(), b"");
/// # Ok::<(), frixel_hil_sim::OutOfRange>(())
/// ```
#[derive(Clone, Debug)]
pub struct Line {
    /// Progress of the current byte per tick; the byte is complete at `byte_cost`.
    progress_per_tick: u64,
    byte_cost: u64,
    progress: u64,
    queue: VecDeque<u8>,
    queue_max_len: usize,
    arrived: Vec<u8>,
    /// Number of bytes that have arrived.
    delivered: u64,
}

impl Line {
    /// A line of `baud` bits per second, advanced at `tick_hz`; both above 0.
    pub fn new(baud: u32, tick_hz: u32) -> Result<Self, OutOfRange> {
        for (name, value) in [("baud", baud), ("tick_hz", tick_hz)] {
            if value == 0 {
                return Err(OutOfRange { name, expected: "above 0", found: 0.0 });
            }
        }
        Ok(Self {
            progress_per_tick: u64::from(baud),
            byte_cost: BITS_PER_BYTE * u64::from(tick_hz),
            progress: 0,
            queue: VecDeque::new(),
            queue_max_len: usize::MAX,
            arrived: Vec::new(),
            delivered: 0,
        })
    }

    /// Limits the queue to `len` bytes from now on. Further bytes are lost.
    pub fn limit_queue(&mut self, len: usize) {
        self.queue_max_len = len;
    }

    /// Queues bytes. On an idle line the first of them starts now, at the tick boundary.
    pub fn send(&mut self, bytes: &[u8]) {
        let room = self.queue_max_len.saturating_sub(self.queue.len());
        self.queue.extend(bytes.iter().take(room));
    }

    /// Advances one tick, and returns the bytes that arrived in it.
    pub fn tick(&mut self) -> &[u8] {
        self.arrived.clear();
        if self.queue.is_empty() {
            return &self.arrived;
        }
        self.progress += self.progress_per_tick;
        while self.progress >= self.byte_cost {
            let Some(byte) = self.queue.pop_front() else { break };
            self.progress -= self.byte_cost;
            self.delivered += 1;
            self.arrived.push(byte);
        }
        if self.queue.is_empty() {
            // The next byte cannot start before `send` queues it.
            self.progress = 0;
        }
        &self.arrived
    }

    /// Number of bytes that are queued or on the line.
    pub fn queued(&self) -> usize {
        self.queue.len()
    }

    /// Number of bytes that have arrived so far.
    pub fn delivered(&self) -> u64 {
        self.delivered
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::Line;

    const TICK_HZ: u32 = 40_000;

    /// Returns the tick in which each of `count` bytes arrives, all sent at once; the first tick is 1.
    fn arrivals(line: &mut Line, count: usize) -> Vec<u64> {
        let bytes: Vec<u8> = (0..count).map(|number| number as u8).collect();
        line.send(&bytes);
        let mut arrivals = Vec::new();
        let mut received = Vec::new();
        let mut tick = 0;
        while line.queued() > 0 {
            tick += 1;
            let delivered = line.tick();
            received.extend_from_slice(delivered);
            arrivals.extend(delivered.iter().map(|_| tick));
        }
        assert_eq!(received, bytes);
        arrivals
    }

    proptest! {
        #[test]
        fn a_byte_takes_ten_bit_times_at_any_rate(baud in 300..6_000_000_u32, tick_hz in 1000..100_000_u32) {
            let arrivals = arrivals(&mut Line::new(baud, tick_hz).unwrap(), 200);
            for (number, &tick) in arrivals.iter().enumerate() {
                // The first tick whose end, tick / tick_hz, is not before the byte's, 10 (number + 1) / baud.
                let expected = (10 * (number as u64 + 1) * u64::from(tick_hz)).div_ceil(u64::from(baud));
                prop_assert_eq!(tick, expected);
            }
        }
    }

    #[test]
    fn an_idle_line_saves_no_time_up() {
        let mut line = Line::new(115_200, TICK_HZ).unwrap();
        let first = arrivals(&mut line, 3);
        for _ in 0..1000 {
            assert_eq!(line.tick(), b"");
        }
        assert_eq!(arrivals(&mut line, 3), first);
    }

    #[test]
    fn bytes_beyond_a_full_queue_are_lost_at_once() {
        let mut line = Line::new(2_000_000, TICK_HZ).unwrap();
        line.limit_queue(7);
        line.send(&[1, 2, 3, 4, 5, 6]);
        line.send(&[7, 8, 9]);
        assert_eq!(line.tick(), [1, 2, 3, 4, 5]);
        line.send(&[10]);
        assert_eq!(line.tick(), [6, 7, 10]);
        assert_eq!(line.delivered(), 8);
    }

    #[test]
    fn a_rate_of_zero_is_refused_by_name() {
        assert_eq!(Line::new(0, 1).unwrap_err().to_string(), "baud must be above 0, found 0");
        assert_eq!(Line::new(1, 0).unwrap_err().to_string(), "tick_hz must be above 0, found 0");
    }
}
