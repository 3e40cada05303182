//! The stored limits: a complete copy survives a power failure at any time.

use frixel_control::Board;
use frixel_session::store::{
    COPY_LEN, CeilingPolicy, LIMITS_LEN, Slot, Writer, Writing, first_copy, load_limits, write_limits,
};
use frixel_wire::fault::State;
use frixel_wire::hello::{BoardLimits, notice};
use frixel_wire::message::{Command, Refusal};

use crate::support::TestBoard;
use crate::support::flash::{PAGE_LEN, SimulatedFlash};

const SLOT: Slot = Slot { first_page: 1 };
const PAGES: usize = 4;

fn content(seed: u8) -> [u8; LIMITS_LEN] {
    std::array::from_fn(|at| (at as u8).wrapping_mul(31) ^ seed)
}

/// Writes until the copy is written, the flash has failed, or the power fails.
fn write(flash: &mut SimulatedFlash, content: &[u8; LIMITS_LEN]) -> Writing {
    let mut writer = Writer::new(SLOT, flash, content);
    loop {
        match writer.step(flash) {
            Writing::UnderWay if flash.has_power() => {}
            end => return end,
        }
    }
}

/// A flash to which these contents were written, one after the other.
fn flash_with(contents: &[&[u8; LIMITS_LEN]], torn_words_read: bool) -> SimulatedFlash {
    let mut flash = SimulatedFlash::new(PAGES, torn_words_read);
    for content in contents {
        assert_eq!(write(&mut flash, content), Writing::Done);
    }
    flash.after_power_on()
}

/// Cuts the power at every byte of writing `new`, and checks the content after each.
fn cut_everywhere(before: &SimulatedFlash, kept: Option<[u8; LIMITS_LEN]>, new: &[u8; LIMITS_LEN]) {
    let mut whole = before.clone();
    assert_eq!(write(&mut whole, new), Writing::Done);
    assert_eq!(whole.done, PAGE_LEN + COPY_LEN);
    for cut in 0..=whole.done {
        let mut flash = before.clone();
        flash.power_left = Some(cut);
        let end = write(&mut flash, new);
        let mut flash = flash.after_power_on();
        let now = SLOT.find(&flash);
        assert!(now == Some(*new) || now == kept && end != Writing::Done, "cut at {cut}");
        flash.power_left = Some(cut);
        write(&mut flash, &content(98));
        flash = flash.after_power_on();
        let found = SLOT.find(&flash);
        assert!(found == Some(content(98)) || found == now, "cut twice at {cut}");
        let next = content(99);
        assert_eq!(write(&mut flash, &next), Writing::Done);
        assert_eq!(SLOT.find(&flash), Some(next), "written after a cut at {cut}");
    }
}

#[test]
fn a_power_cut_at_any_byte_leaves_one_good_copy() {
    let (first, second, third) = (content(1), content(2), content(3));
    for torn_words_read in [false, true] {
        cut_everywhere(&flash_with(&[], torn_words_read), None, &first);
        cut_everywhere(&flash_with(&[&first], torn_words_read), Some(first), &second);
        cut_everywhere(&flash_with(&[&first, &second], torn_words_read), Some(second), &third);
    }
}

#[test]
fn failing_flash_leaves_the_previous_copy() {
    let mut flash = flash_with(&[&content(1)], false);
    flash.is_worn = true;
    assert_eq!(write(&mut flash, &content(2)), Writing::Failed);
    assert_eq!(SLOT.find(&flash), Some(content(1)));
}

#[test]
fn a_corrupt_copy_is_superseded_by_the_older_one_and_overwritten() {
    let (first, second) = (content(1), content(2));
    let newest = flash_with(&[&first, &second], false);
    for at in 0..PAGES * PAGE_LEN {
        let mut flash = newest.clone();
        flash.bytes[at] ^= 0x10;
        // The second copy lies in the page behind the first.
        let is_rotten = (2 * PAGE_LEN..2 * PAGE_LEN + COPY_LEN).contains(&at);
        assert_eq!(SLOT.find(&flash), Some(if is_rotten { first } else { second }), "{at}");
        assert_eq!(write(&mut flash, &content(3)), Writing::Done);
        assert_eq!(SLOT.find(&flash), Some(content(3)));
    }
}

#[test]
fn the_first_copy_equals_what_a_writer_leaves_in_erased_flash() {
    let flash = flash_with(&[&content(1)], false);
    assert_eq!(flash.bytes[PAGE_LEN..PAGE_LEN + COPY_LEN], first_copy(&content(1)));
}

/// A build with the other setting starts as if nothing were stored, and every start reports the reason.
#[test]
fn a_board_starts_with_stored_limits_only_if_its_build_allows_them() {
    let built_in = BoardLimits { voltage_max_v_peak: 50.0, full_scale_v_peak: 300.0, ..Board::NUCLEO_G474RE.limits };
    let stored = |voltage_max_v_peak| BoardLimits {
        voltage_max_v_peak,
        current_max_a_rms: 0.5e-3,
        current_max_a_peak: 1.8e-3,
        ..built_in
    };
    let (low, high) = (stored(150.0), stored(300.0));
    let (in_force, lifted) = (CeilingPolicy::InForce, CeilingPolicy::Lifted);
    let (refused, above) = (notice::STORED_LIMITS_REFUSED, notice::LIMITS_ABOVE_CEILINGS);
    let load = |flash: &SimulatedFlash, ceilings| load_limits(Some(flash), SLOT, &built_in, ceilings);

    let empty = SimulatedFlash::new(PAGES, false);
    assert_eq!(load(&empty, in_force), (built_in, 0));
    assert_eq!(load(&empty, lifted), (built_in, above));
    assert_eq!(load_limits(None::<&SimulatedFlash>, SLOT, &built_in, in_force), (built_in, 0));

    let written = |limits, ceilings| flash_with(&[&write_limits(limits, ceilings).unwrap()], false);
    let flash = written(&low, in_force);
    assert_eq!(load(&flash, in_force), (low, 0));
    assert_eq!(load(&flash, lifted), (built_in, refused | above));
    let flash = written(&high, lifted);
    assert_eq!(load(&flash, lifted), (high, above));
    assert_eq!(load(&flash, in_force), (built_in, refused));

    // The only copy is damaged.
    let mut damaged = written(&low, in_force);
    damaged.bytes[SLOT.first_page as usize * PAGE_LEN + 20] ^= 1;
    assert_eq!(load(&damaged, in_force), (built_in, refused));

    let mut board = TestBoard::of(Board { notices: refused, ..Board::SIMULATOR });
    assert_eq!(board.hello().notices, refused);
}

/// In the pages of the limits they cause a notice; elsewhere they are ignored.
#[test]
fn bytes_of_another_layout_are_never_limits() {
    let built_in = Board::NUCLEO_G474RE.limits;
    let mut copy = first_copy(&write_limits(&built_in, CeilingPolicy::InForce).unwrap());
    copy[3] += 1;
    for bytes in [&copy[..], b"another program's settings"] {
        for page in 0..PAGES {
            let mut flash = SimulatedFlash::new(PAGES, true);
            flash.bytes[page * PAGE_LEN..][..bytes.len()].copy_from_slice(bytes);
            let is_of_limits = (page as u32).wrapping_sub(SLOT.first_page) < 2;
            let notices = if is_of_limits { notice::STORED_LIMITS_REFUSED } else { 0 };
            assert_eq!(
                load_limits(Some(&flash), SLOT, &built_in, CeilingPolicy::InForce),
                (built_in, notices),
                "{page}"
            );
        }
    }
}

#[test]
fn wrong_option_bytes_are_in_the_hello_and_refuse_arming() {
    let mut board = TestBoard::of(Board { notices: notice::OPTION_BYTES, ..Board::NUCLEO_G474RE });
    assert_eq!(board.hello().notices, notice::OPTION_BYTES);
    assert_eq!(board.command(Command::Arm), Err(Refusal::OptionBytes));
    board.ticks(10);
    assert_eq!(board.status().telemetry.state, State::Disarmed);
}
