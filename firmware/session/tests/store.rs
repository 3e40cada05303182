//! The scene store: a stored scene is restored whole, whenever the power fails.
#![cfg(all(feature = "store", feature = "bitmap"))]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "helpers of tests fail as tests do")]

use crate::support;

use frixel_control::{Board, Drive};
use frixel_layers::{Bitmap, Layer, Record, Region};
use frixel_session::store::{Ceilings, Found, SceneStore, Slot, WORD_LEN, Writer, Writing, load_limits, write_limits};
use frixel_wire::frame::crc32;
use frixel_wire::hello::{BoardLimits, ResetCause, notice};
use frixel_wire::message::{Accepted, Command};
use frixel_wire::scene::bitmap_crc32;
use proptest::prelude::*;
use support::flash::{Operations, PAGE_LEN, SimulatedFlash};
use support::{HEADER, TestBoard, constant_scene, record, scene};

const SLOT: Slot = Slot { first_page: 1, pages: 3 };
const PAGES: usize = 8;

fn content(seed: u8, len: usize) -> Vec<u8> {
    (0..len).map(|at| (at as u8).wrapping_mul(31) ^ seed).collect()
}

fn word_of(content: &[u8], offset: u32) -> [u8; WORD_LEN] {
    let mut word = [0; WORD_LEN];
    let rest = &content[offset as usize..];
    let len = rest.len().min(WORD_LEN);
    word[..len].copy_from_slice(&rest[..len]);
    word
}

/// Writes until it is done, has failed, or the power goes.
fn write(flash: &mut SimulatedFlash, found: Option<&Found>, content: &[u8]) -> Writing {
    let mut writer = Writer::new::<SimulatedFlash>(SLOT, found, content.len() as u32).expect("it fits");
    loop {
        match writer.step(flash, |offset| word_of(content, offset)) {
            Writing::Busy | Writing::UnderWay if flash.has_power() => {}
            end => return end,
        }
    }
}

fn written(flash: &mut SimulatedFlash, content: &[u8]) {
    let found = SLOT.find(flash);
    assert!(matches!(write(flash, found.as_ref(), content), Writing::Done(_)));
}

fn found(flash: &SimulatedFlash) -> Option<Vec<u8>> {
    let found = SLOT.find(flash)?;
    let mut content = vec![0; found.len as usize];
    assert!(SLOT.read(flash, &found, 0, &mut content));
    assert_eq!(crc32(&content), found.crc32);
    Some(content)
}

/// A flash in which these were written, one after the other.
fn flash_with(contents: &[&[u8]], torn_words_read: bool) -> SimulatedFlash {
    let mut flash = SimulatedFlash::new(PAGES, torn_words_read);
    for content in contents {
        written(&mut flash, content);
    }
    flash.after_power_on()
}

/// Cuts the power at every byte of writing `new`, and checks the content after each.
fn cut_everywhere(before: &SimulatedFlash, kept: Option<&[u8]>, new: &[u8]) {
    let mut whole = before.clone();
    written(&mut whole, new);
    assert!(whole.done > new.len());
    for cut in 0..=whole.done {
        let mut flash = before.clone();
        flash.power_left = Some(cut);
        let found_before = SLOT.find(&flash);
        let end = write(&mut flash, found_before.as_ref(), new);
        let mut flash = flash.after_power_on();
        let now = found(&flash);
        if matches!(end, Writing::Done(_)) {
            assert_eq!(now.as_deref(), Some(new), "cut at {cut}");
        } else {
            assert!(now.as_deref() == kept || now.as_deref() == Some(new), "cut at {cut}");
        }
        let next = content(99, 600);
        written(&mut flash, &next);
        assert_eq!(found(&flash), Some(next), "written after a cut at {cut}");
    }
}

#[test]
fn a_power_cut_at_any_byte_leaves_one_good_copy() {
    let (first, second, third) = (content(1, 700), content(2, 1001), content(3, 900));
    for torn_words_read in [false, true] {
        cut_everywhere(&flash_with(&[], torn_words_read), None, &first);
        cut_everywhere(&flash_with(&[&first], torn_words_read), Some(&first), &second);
        cut_everywhere(&flash_with(&[&first, &second], torn_words_read), Some(&second), &third);
    }
}

/// An operation that was begun before the board was armed may last as long as the play, and has its time afterwards.
#[test]
fn the_hello_says_that_a_flash_which_never_ends_an_operation_has_not_stored_the_scene() {
    const OPERATION_MAX_TICKS: u32 = 5 * 40_000;
    let mut flash = scene_flash();
    flash.operations = Operations::NeverEnd;
    let mut board = TestBoard::new();
    let mut store = SceneStore::new(SCENE_SLOT, 40_000, &flash, &mut board.session);
    board.hello();
    load_and_wait(&mut board, &mut store, &mut flash, &constant_scene(0.01), 0);
    finish_writing_at(&mut store, &mut flash, &mut board, STORE_AFTER_TICKS);
    board.command(Command::Arm).unwrap();
    let disarmed_at = 60 * 40_000;
    store.step(&mut flash, &mut board.session, disarmed_at);
    board.command(Command::Disarm).unwrap();
    board.press_switch();
    store.step(&mut flash, &mut board.session, disarmed_at + OPERATION_MAX_TICKS - 1);
    assert_eq!((flash.done, board.hello().notices), (PAGE_LEN, 0));
    store.step(&mut flash, &mut board.session, disarmed_at + OPERATION_MAX_TICKS);
    assert_eq!((flash.done, board.hello().notices), (PAGE_LEN, notice::SCENE_NOT_STORED));
}

proptest! {
    /// Any number of cuts, one after the other: what was whole before is there until something newer is.
    #[test]
    fn cuts_in_a_row_lose_nothing(cuts in proptest::collection::vec(0_usize..4000, 1..12), reads in any::<bool>()) {
        let mut flash = flash_with(&[&content(0, 800)], reads);
        let mut kept = content(0, 800);
        for (number, cut) in (1..).zip(cuts) {
            let new = content(number, 300 + 97 * usize::from(number));
            flash.power_left = Some(cut);
            let found_before = SLOT.find(&flash);
            write(&mut flash, found_before.as_ref(), &new);
            flash = flash.after_power_on();
            let now = found(&flash).unwrap();
            prop_assert!(now == kept || now == new);
            kept = now;
        }
    }
}

#[test]
fn flash_that_fails_leaves_the_copy_before() {
    let kept = content(1, 700);
    let mut flash = flash_with(&[&kept], false);
    flash.operations = Operations::Fail;
    let found_before = SLOT.find(&flash);
    assert_eq!(write(&mut flash, found_before.as_ref(), &content(2, 700)), Writing::Failed);
    assert_eq!(found(&flash), Some(kept));
}

#[test]
fn a_rotten_copy_gives_way_to_the_older_one_and_is_written_over() {
    let (first, second) = (content(1, 700), content(2, 700));
    let newest = flash_with(&[&first, &second], false);
    for at in 0..(PAGES * PAGE_LEN) {
        let mut flash = newest.clone();
        flash.bytes[at] ^= 0x10;
        let now = found(&flash).unwrap();
        // The second copy lies behind the first.
        let in_second = (4 * PAGE_LEN..7 * PAGE_LEN).contains(&at);
        assert!(now == second || (in_second && now == first), "{at}");
        let third = content(3, 650);
        written(&mut flash, &third);
        assert_eq!(found(&flash), Some(third));
        assert!(found(&flash).is_some());
    }
}

#[test]
fn a_scene_larger_than_its_slot_is_not_written() {
    let capacity = SLOT.capacity::<SimulatedFlash>();
    assert!(Writer::new::<SimulatedFlash>(SLOT, None, capacity).is_some());
    assert!(Writer::new::<SimulatedFlash>(SLOT, None, capacity + 1).is_none());
}

const SCENE_SLOT: Slot = Slot { first_page: 0, pages: 24 };
const STORE_AFTER_TICKS: u32 = 80_000;

fn scene_flash() -> SimulatedFlash {
    SimulatedFlash::new(48, false)
}

/// A scene of two bitmaps, one of them used twice.
fn textured(board: &mut TestBoard) -> Vec<u8> {
    let layer = |crc32, pitch_m| {
        Layer::Bitmap(Bitmap {
            crc32,
            x_m: 0.0,
            y_m: 0.0,
            pitch_m,
            black_n: 0.0,
            white_n: 0.02,
            pitch_y_m: pitch_m,
            angle_turns: 0.0,
            tiled: false,
        })
    };
    let pictures = [content(7, 61 * 53), content(8, 9)];
    board.upload_bitmap(61, 53, &pictures[0]).unwrap();
    board.upload_bitmap(3, 3, &pictures[1]).unwrap();
    let first = bitmap_crc32(61, 53, &pictures[0]);
    let second = bitmap_crc32(3, 3, &pictures[1]);
    // Side by side: one on another they would take too long.
    let beside = |x_m, layer| {
        let region = Region::Rectangle { x_m, y_m: 0.0, width_m: 0.03, height_m: 0.1 };
        Record { region, ..record(layer) }
    };
    let left = beside(0.0, layer(first, 1e-3));
    scene(&HEADER, &[left, beside(0.04, layer(second, 1e-2)), beside(0.08, layer(first, 7e-4))])
}

/// A build with the other setting starts as if nothing were stored, and every start says what is the matter.
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
    let (in_force, lifted) = (Ceilings::InForce, Ceilings::Lifted);
    let (refused, above) = (notice::STORED_LIMITS_REFUSED, notice::LIMITS_ABOVE_CEILINGS);
    let load = |flash: &SimulatedFlash, ceilings| load_limits(Some(flash), SLOT, &built_in, ceilings);

    let empty = SimulatedFlash::new(PAGES, false);
    assert_eq!(load(&empty, in_force), (built_in, 0));
    assert_eq!(load(&empty, lifted), (built_in, above));
    let without_flash = load_limits(None::<&SimulatedFlash>, SLOT, &built_in, in_force);
    assert_eq!(without_flash, (built_in, notice::SCENE_NOT_STORED));

    let written = |limits, ceilings| flash_with(&[&write_limits(limits, ceilings).unwrap()], false);
    let flash = written(&low, in_force);
    assert_eq!(load(&flash, in_force), (low, 0));
    assert_eq!(load(&flash, lifted), (built_in, refused | above));
    let flash = written(&high, lifted);
    assert_eq!(load(&flash, lifted), (high, above));
    assert_eq!(load(&flash, in_force), (built_in, refused));

    // Above a ceiling, under the version of a build that has ceilings.
    let mut bytes = write_limits(&high, lifted).unwrap();
    bytes[0] = 3;
    assert_eq!(load(&flash_with(&[&bytes], false), in_force), (built_in, refused));
    assert_eq!(load(&flash_with(&[&bytes[..20]], false), in_force), (built_in, refused));

    let mut board = TestBoard::of(Board { notices: refused, ..Board::SIMULATOR });
    assert_eq!(board.hello().notices, refused);
}

/// Steps the scene store 30,000 times, enough to finish any write.
fn finish_writing(store: &mut SceneStore, flash: &mut SimulatedFlash, board: &mut TestBoard, mut now_tick: u32) {
    for _ in 0..30_000 {
        store.step(flash, &mut board.session, now_tick);
        now_tick = now_tick.wrapping_add(STORE_AFTER_TICKS / 3);
    }
}

fn played(board: &mut TestBoard) -> Vec<Drive> {
    board.command(Command::Arm).unwrap();
    board.command(Command::Play).unwrap();
    board.slide(4000)
}

/// A board that has written a scene with a picture to its flash, the flash and the scene.
fn with_stored_texture() -> (TestBoard, SimulatedFlash, Vec<u8>) {
    let mut flash = scene_flash();
    let mut board = TestBoard::new();
    let mut store = SceneStore::new(SCENE_SLOT, 40_000, &flash, &mut board.session);
    board.hello();
    let scene = textured(&mut board);
    board.load(&scene).unwrap();
    finish_writing(&mut store, &mut flash, &mut board, 0);
    assert_eq!((store.stored_crc32(), board.hello().notices), (Some(crc32(&scene)), 0));
    (board, flash, scene)
}

#[test]
fn the_last_scene_plays_after_power_off() {
    let (mut board, flash, scene) = with_stored_texture();
    let before = played(&mut board);
    assert!(before.iter().any(|drive| drive.dac_code.bits() != 0));

    let mut board = TestBoard::new();
    SceneStore::new(SCENE_SLOT, 40_000, &flash, &mut board.session);
    let hello = board.hello();
    assert_eq!(hello.scene_crc32, crc32(&scene));
    assert_eq!(hello.state, frixel_wire::fault::State::Disarmed);
    assert_eq!(board.session.scene(), Some(scene.as_slice()));
    assert!(played(&mut board) == before);
}

/// Starts a board with this flash after so many starts that ended in a fault, each of which has reset it.
fn start_after_faults(flash: &SimulatedFlash, fault_starts: u8) -> (TestBoard, SceneStore) {
    let reset_cause = if fault_starts > 0 { ResetCause::Software } else { ResetCause::PowerOn };
    let board = Board { reset_cause, reset_fault_starts: fault_starts, ..Board::SIMULATOR };
    let mut board = TestBoard::of(board);
    let store = SceneStore::new(SCENE_SLOT, 40_000, flash, &mut board.session);
    (board, store)
}

#[test]
fn a_stored_scene_is_skipped_after_three_starts_in_a_row_that_ended_in_a_fault() {
    let (_, flash, scene) = with_stored_texture();
    for (fault_starts, skipped) in [(0, false), (1, false), (2, false), (3, true), (4, true), (255, true)] {
        let (mut board, store) = start_after_faults(&flash, fault_starts);
        let hello = board.hello();
        let expected = if skipped { (0, notice::STORED_SCENE_SKIPPED) } else { (crc32(&scene), 0) };
        assert_eq!((hello.scene_crc32, hello.notices), expected, "{fault_starts}");
        assert_eq!(store.stored_crc32().is_none(), skipped, "{fault_starts}");
        assert_eq!(board.command(Command::Arm), Ok(Accepted::Done));
        assert_eq!(board.command(Command::Play).is_err(), skipped, "{fault_starts}");
    }
}

#[test]
fn a_skipped_scene_plays_again_once_a_start_has_not_followed_faults() {
    let (_, mut flash, scene) = with_stored_texture();
    let (mut board, mut store) = start_after_faults(&flash, 3);
    let done = flash.done;
    board.hello();
    finish_writing(&mut store, &mut flash, &mut board, 0);
    assert_eq!(flash.done, done, "skipping a scene writes nothing");

    let (mut board, _) = start_after_faults(&flash, 0);
    let hello = board.hello();
    assert_eq!((hello.scene_crc32, hello.notices), (crc32(&scene), 0));
    assert!(played(&mut board).iter().any(|drive| drive.dac_code.bits() != 0));
}

#[test]
fn a_scene_that_is_stored_in_place_of_a_skipped_one_plays_at_the_next_start() {
    let (_, mut flash, _) = with_stored_texture();
    let (mut board, mut store) = start_after_faults(&flash, 3);
    board.hello();
    let fine = constant_scene(0.02);
    board.load(&fine).unwrap();
    let hello = board.hello();
    assert_eq!((hello.scene_crc32, hello.notices), (crc32(&fine), 0));
    store.step(&mut flash, &mut board.session, 0);
    finish_writing_at(&mut store, &mut flash, &mut board, 44 * 60 * 40_000);
    assert_eq!(store.stored_crc32(), None, "a fault has reset the board: its first write waits");
    finish_writing(&mut store, &mut flash, &mut board, 45 * 60 * 40_000);
    assert_eq!(store.stored_crc32(), Some(crc32(&fine)));

    let (mut board, _) = start_after_faults(&flash, 0);
    let hello = board.hello();
    assert_eq!((hello.scene_crc32, hello.notices), (crc32(&fine), 0));
    assert!(played(&mut board).iter().any(|drive| drive.dac_code.bits() != 0));
}

/// There is nothing to skip, and nothing to say.
#[test]
fn a_board_that_has_stored_no_scene_skips_none() {
    let (mut board, _) = start_after_faults(&scene_flash(), 3);
    assert_eq!(board.hello().notices, 0);
}

#[test]
fn a_scene_is_written_once_and_only_after_the_board_was_disarmed_for_a_while() {
    let mut flash = scene_flash();
    let mut board = TestBoard::new();
    let mut store = SceneStore::new(SCENE_SLOT, 40_000, &flash, &mut board.session);
    board.hello();
    board.load(&constant_scene(0.01)).unwrap();
    let begun = u32::MAX - 1000; // the tick count may wrap
    for after in [0, 1, STORE_AFTER_TICKS - 1] {
        store.step(&mut flash, &mut board.session, begun.wrapping_add(after));
        assert_eq!(flash.done, 0);
    }
    finish_writing(&mut store, &mut flash, &mut board, begun.wrapping_add(STORE_AFTER_TICKS));
    let done = flash.done;
    assert!(done > 0);
    board.load(&constant_scene(0.01)).unwrap();
    finish_writing(&mut store, &mut flash, &mut board, 0);
    assert_eq!(flash.done, done, "the same scene is not written again");
}

/// Steps the scene store until its write has ended; time stands still.
fn finish_writing_at(store: &mut SceneStore, flash: &mut SimulatedFlash, board: &mut TestBoard, tick: u32) {
    for _ in 0..30_000 {
        store.step(flash, &mut board.session, tick);
    }
}

/// Loads a scene, and lets the board be disarmed with it until it may be stored.
fn load_and_wait(board: &mut TestBoard, store: &mut SceneStore, flash: &mut SimulatedFlash, scene: &[u8], tick: u32) {
    board.load(scene).unwrap();
    store.step(flash, &mut board.session, tick);
}

#[test]
fn two_writes_of_a_slot_are_45_minutes_apart_and_the_last_scene_wins() {
    const INTERVAL_TICKS: u32 = 45 * 60 * 40_000;
    let mut flash = scene_flash();
    let mut board = TestBoard::new();
    let mut store = SceneStore::new(SCENE_SLOT, 40_000, &flash, &mut board.session);
    board.hello();
    let mut begun = 100;
    load_and_wait(&mut board, &mut store, &mut flash, &constant_scene(0.01), begun);
    begun += STORE_AFTER_TICKS;
    finish_writing_at(&mut store, &mut flash, &mut board, begun);
    assert_eq!(store.stored_crc32(), Some(crc32(&constant_scene(0.01))), "the first does not wait");

    // Over the wrap of the tick count, too: 2^32 ticks are some 40 intervals.
    let mut erased = flash.done;
    for number in 0..50 {
        let scenes = [0.02, 0.03, 0.04].map(|newtons| constant_scene(newtons + 1e-4 * number as f32));
        for (scene, tenth) in scenes.iter().zip([2, 5, 8]) {
            let tick = begun.wrapping_add(INTERVAL_TICKS / 10 * tenth);
            load_and_wait(&mut board, &mut store, &mut flash, scene, tick);
            finish_writing_at(&mut store, &mut flash, &mut board, tick.wrapping_add(STORE_AFTER_TICKS));
        }
        finish_writing_at(&mut store, &mut flash, &mut board, begun.wrapping_add(INTERVAL_TICKS - 1));
        assert_eq!(flash.done, erased, "{number}");
        begun = begun.wrapping_add(INTERVAL_TICKS);
        finish_writing_at(&mut store, &mut flash, &mut board, begun);
        assert_eq!(store.stored_crc32(), Some(crc32(&scenes[2])), "{number}");
        erased = flash.done;
    }
}

#[test]
fn a_board_that_resets_again_and_again_does_not_write() {
    let mut flash = scene_flash();
    let causes = [ResetCause::Software, ResetCause::Watchdog, ResetCause::BrownOut, ResetCause::Other(9)];
    for (number, reset_cause) in (1_u8..).zip(causes) {
        let mut board = TestBoard::of(Board { reset_cause, ..Board::SIMULATOR });
        let mut store = SceneStore::new(SCENE_SLOT, 40_000, &flash, &mut board.session);
        board.hello();
        load_and_wait(&mut board, &mut store, &mut flash, &constant_scene(0.01 * f32::from(number)), 0);
        finish_writing_at(&mut store, &mut flash, &mut board, 44 * 60 * 40_000);
        assert_eq!(flash.done, 0, "{reset_cause:?}");
    }
    for reset_cause in [ResetCause::PowerOn, ResetCause::Pin] {
        let mut flash = scene_flash();
        let mut board = TestBoard::of(Board { reset_cause, ..Board::SIMULATOR });
        let mut store = SceneStore::new(SCENE_SLOT, 40_000, &flash, &mut board.session);
        board.hello();
        load_and_wait(&mut board, &mut store, &mut flash, &constant_scene(0.01), 0);
        finish_writing_at(&mut store, &mut flash, &mut board, STORE_AFTER_TICKS);
        assert!(flash.done > 0, "{reset_cause:?}: a person's scene is stored at once");
    }
}

/// Its pages are erased already: to begin anew would wear them once more.
#[test]
fn a_write_that_arming_interrupts_goes_on_once_the_board_is_disarmed() {
    let mut flash = scene_flash();
    let mut board = TestBoard::new();
    let mut store = SceneStore::new(SCENE_SLOT, 40_000, &flash, &mut board.session);
    board.hello();
    let scene = textured(&mut board);
    load_and_wait(&mut board, &mut store, &mut flash, &scene, 0);
    let mut uninterrupted = flash.clone();
    let mut cuts = 0;
    while store.stored_crc32().is_none() {
        for _ in 0..300 {
            store.step(&mut flash, &mut board.session, STORE_AFTER_TICKS);
        }
        board.command(Command::Arm).unwrap();
        let done = flash.done;
        finish_writing_at(&mut store, &mut flash, &mut board, STORE_AFTER_TICKS);
        assert_eq!(flash.done, done);
        board.command(Command::Disarm).unwrap();
        board.press_switch();
        cuts += 1;
    }
    assert!(cuts > 3, "{cuts}");
    assert_eq!((store.stored_crc32(), board.hello().notices), (Some(crc32(&scene)), 0));

    let mut board = TestBoard::new();
    let mut store = SceneStore::new(SCENE_SLOT, 40_000, &uninterrupted, &mut board.session);
    board.hello();
    let scene = textured(&mut board);
    load_and_wait(&mut board, &mut store, &mut uninterrupted, &scene, 0);
    finish_writing_at(&mut store, &mut uninterrupted, &mut board, STORE_AFTER_TICKS);
    assert_eq!(uninterrupted.done, flash.done);
    assert!(uninterrupted.bytes == flash.bytes);
}

#[test]
fn nothing_is_written_unless_the_board_is_disarmed() {
    let mut flash = scene_flash();
    let mut board = TestBoard::new();
    let mut store = SceneStore::new(SCENE_SLOT, 40_000, &flash, &mut board.session);
    board.hello();
    let kept = constant_scene(0.01);
    board.load(&kept).unwrap();
    finish_writing(&mut store, &mut flash, &mut board, 0);

    board.load(&constant_scene(0.02)).unwrap();
    board.command(Command::Arm).unwrap();
    let done = flash.done;
    finish_writing(&mut store, &mut flash, &mut board, 0);
    board.command(Command::Play).unwrap();
    finish_writing(&mut store, &mut flash, &mut board, 0);
    assert_eq!(flash.done, done);

    // Armed in the middle of a write: it ends there, and the copy before is still the one.
    board.command(Command::Disarm).unwrap();
    board.press_switch();
    store.step(&mut flash, &mut board.session, 0);
    while flash.done < done + PAGE_LEN + 40 {
        store.step(&mut flash, &mut board.session, STORE_AFTER_TICKS);
    }
    board.command(Command::Arm).unwrap();
    let done = flash.done;
    assert!(!flash.is_at_rest());
    finish_writing(&mut store, &mut flash, &mut board, 0);
    assert_eq!(flash.done, done);
    assert!(flash.is_at_rest(), "somebody has to see the operation to its end");
    let mut after = TestBoard::new();
    SceneStore::new(SCENE_SLOT, 40_000, &flash.after_power_on(), &mut after.session);
    assert_eq!(after.hello().scene_crc32, crc32(&kept));
}

#[test]
fn a_scene_that_the_board_can_no_longer_play_is_left_alone() {
    let (_, flash, _) = with_stored_texture();

    let limits = BoardLimits { voltage_max_v_peak: 50.0, ..Board::SIMULATOR.limits };
    let mut board = TestBoard::of(Board { limits, ..Board::SIMULATOR });
    let store = SceneStore::new(SCENE_SLOT, 40_000, &flash, &mut board.session);
    assert_eq!(store.stored_crc32(), None);
    assert_eq!((board.hello().scene_crc32, board.session.scene()), (0, None));
    // The whole pool is free.
    board.upload_bitmap(256, 256, &vec![5; 64 * 1024]).unwrap();
}

/// What a good CRC stands over need not be good itself.
#[test]
fn a_bitmap_that_is_not_its_name_is_not_held() {
    let mut board = TestBoard::connected();
    let scene = textured(&mut board);
    board.load(&scene).unwrap();
    let kept = board.session.scene_to_store().unwrap();
    let mut bytes: Vec<u8> = (0..kept.len_to_keep()).step_by(WORD_LEN).flat_map(|offset| kept.word(offset)).collect();
    let sample = bytes.len() - 16 - 100;
    bytes[sample] ^= 1;

    let mut board = TestBoard::new();
    assert!(!board.session.restore(|offset, word| {
        word.copy_from_slice(&bytes[offset as usize..][..word.len()]);
        true
    }));
    board.hello();
    assert_eq!(board.upload_bitmap(61, 53, &content(7, 61 * 53)), Ok(Accepted::Done));
}

#[test]
fn a_flash_that_fails_is_tried_once_for_each_scene_and_the_hello_says_that_it_is_not_stored() {
    let mut flash = scene_flash();
    flash.operations = Operations::Fail;
    let mut board = TestBoard::new();
    let mut store = SceneStore::new(SCENE_SLOT, 40_000, &flash, &mut board.session);
    board.hello();
    for (scene, tries) in [(constant_scene(0.01), 1), (constant_scene(0.01), 1), (constant_scene(0.02), 2)] {
        board.load(&scene).unwrap();
        assert_eq!(board.hello().notices, if tries == 1 && flash.done > 0 { notice::SCENE_NOT_STORED } else { 0 });
        finish_writing(&mut store, &mut flash, &mut board, 0);
        assert_eq!((flash.done, board.hello().notices), (tries * PAGE_LEN, notice::SCENE_NOT_STORED));
    }
    flash.operations = Operations::Succeed;
    board.load(&constant_scene(0.03)).unwrap();
    assert_eq!(board.hello().notices, 0, "it waits to be stored");
    finish_writing(&mut store, &mut flash, &mut board, 0);
    assert_eq!((store.stored_crc32(), board.hello().notices), (Some(crc32(&constant_scene(0.03))), 0));
    board.load(&constant_scene(0.02)).unwrap();
    assert_eq!(board.hello().notices, 0, "it is tried again");
}

proptest! {
    /// Arbitrary bytes with a valid CRC neither panic nor restore a scene.
    #[test]
    fn arbitrary_bytes_restore_nothing(
        mut bytes in proptest::collection::vec(any::<u8>(), 0..600),
        scene_len in 0_u32..200,
        bitmaps in 0_u32..5,
        tame in any::<bool>(),
    ) {
        if tame && bytes.len() >= 8 {
            bytes[..4].copy_from_slice(&scene_len.to_le_bytes());
            bytes[4..8].copy_from_slice(&bitmaps.to_le_bytes());
        }
        let mut board = TestBoard::new();
        let restored = board.session.restore(|offset, word| {
            let offset = offset as usize;
            match bytes.get(offset..offset + word.len()) {
                Some(found) => { word.copy_from_slice(found); true }
                None => false,
            }
        });
        prop_assert!(!restored);
        prop_assert_eq!(board.hello().scene_crc32, 0);
    }
}
