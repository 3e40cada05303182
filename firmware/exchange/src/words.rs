//! Values to and from words.

use crate::{TICK_BYTES_MAX, TickBytes};
use frixel_session::Touch;

const TOUCH_NONE: u32 = 0;
const TOUCH_UP: u32 = 1;
const TOUCH_DOWN: u32 = 2;

/// Bits of a word that say what kind of touch report there is.
pub(crate) const TOUCH_MASK: u32 = 3;

pub(crate) fn touch_kind(touch: Option<Touch>) -> u32 {
    match touch {
        None => TOUCH_NONE,
        Some(Touch::Up) => TOUCH_UP,
        Some(Touch::Down { .. }) => TOUCH_DOWN,
    }
}

pub(crate) fn put_touch(touch: Option<Touch>, put: &mut impl FnMut(u32)) {
    if let Some(Touch::Down { x_m, y_m, age_ticks }) = touch {
        put(x_m.to_bits());
        put(y_m.to_bits());
        put(age_ticks);
    }
}

pub(crate) fn take_touch(kind: u32, take: &mut impl FnMut() -> u32) -> Option<Touch> {
    match kind & TOUCH_MASK {
        TOUCH_UP => Some(Touch::Up),
        TOUCH_DOWN => Some(Touch::Down { x_m: f32::from_bits(take()), y_m: f32::from_bits(take()), age_ticks: take() }),
        _ => None,
    }
}

pub(crate) fn put_bytes(bytes: &[u8], put: &mut impl FnMut(u32)) {
    for four in bytes.chunks(4) {
        let mut word = [0; 4];
        for (to, from) in word.iter_mut().zip(four) {
            *to = *from;
        }
        put(u32::from_le_bytes(word));
    }
}

pub(crate) fn take_bytes(count: usize, take: &mut impl FnMut() -> u32) -> TickBytes {
    let mut bytes = TickBytes::new();
    while bytes.len() < count.min(TICK_BYTES_MAX) {
        let left = count - bytes.len();
        for byte in take().to_le_bytes().into_iter().take(left) {
            // There is room, as the loop's condition ensures.
            let _ = bytes.push(byte);
        }
    }
    bytes
}
