//! What is kept over power-off: whole, whenever the power goes.
#![cfg(all(feature = "store", feature = "bitmap"))]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "helpers of tests fail as tests do")]

mod support;

use frixel_control::{Board, Drive};
use frixel_layers::{Bitmap, Layer, Record, Region};
use frixel_session::store::{Found, SceneKeeper, Slot, WORD_LEN, Writer, Writing};
use frixel_wire::frame::crc32;
use frixel_wire::hello::BoardLimits;
use frixel_wire::message::{Accepted, Command};
use frixel_wire::scene::bitmap_crc32;
use proptest::prelude::*;
use support::flash::{PAGE_LEN, SimulatedFlash};
use support::{Desk, HEADER, Memory, constant, record, scene};

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
            Writing::UnderWay if flash.has_power() => {}
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

/// Cuts the power at every byte of writing `new`, and looks at what is there when it comes back.
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
    flash.operations_fail = true;
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
fn what_does_not_fit_is_not_begun() {
    let capacity = SLOT.capacity::<SimulatedFlash>();
    assert!(Writer::new::<SimulatedFlash>(SLOT, None, capacity).is_some());
    assert!(Writer::new::<SimulatedFlash>(SLOT, None, capacity + 1).is_none());
}

const SCENE_SLOT: Slot = Slot { first_page: 0, pages: 24 };
const SETTLED_TICKS: u32 = 80_000;

fn scene_flash() -> SimulatedFlash {
    SimulatedFlash::new(48, false)
}

/// A scene of two bitmaps, one of them used twice.
fn textured(desk: &mut Desk) -> Vec<u8> {
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
    desk.upload_bitmap(61, 53, &pictures[0]).unwrap();
    desk.upload_bitmap(3, 3, &pictures[1]).unwrap();
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

/// Steps the keeper until it has nothing more to do.
fn settle(keeper: &mut SceneKeeper, flash: &mut SimulatedFlash, desk: &Desk, mut now_tick: u32) {
    for _ in 0..30_000 {
        keeper.step(flash, &desk.session, now_tick);
        now_tick = now_tick.wrapping_add(SETTLED_TICKS / 3);
    }
}

fn played(desk: &mut Desk) -> Vec<Drive> {
    desk.command(Command::Arm).unwrap();
    desk.command(Command::Play).unwrap();
    desk.slide(4000)
}

#[test]
fn the_last_scene_plays_after_power_off() {
    let mut flash = scene_flash();
    let mut memory = Memory::new();
    let mut desk = Desk::new(&mut memory);
    let mut keeper = SceneKeeper::new(SCENE_SLOT, 40_000, &flash, &mut desk.session);
    desk.greet();
    let scene = textured(&mut desk);
    desk.load(&scene).unwrap();
    settle(&mut keeper, &mut flash, &desk, 0);
    assert_eq!((keeper.settled_crc32(), keeper.failures()), (Some(crc32(&scene)), 0));
    let before = played(&mut desk);
    assert!(before.iter().any(|drive| drive.dac_code.bits() != 0));

    let mut memory = Memory::new();
    let mut desk = Desk::new(&mut memory);
    SceneKeeper::new(SCENE_SLOT, 40_000, &flash, &mut desk.session);
    let hello = desk.greet();
    assert_eq!(hello.scene_crc32, crc32(&scene));
    assert_eq!(hello.state, frixel_wire::fault::State::Disarmed);
    assert_eq!(desk.session.scene(), Some(scene.as_slice()));
    assert!(played(&mut desk) == before);
}

#[test]
fn a_scene_is_written_once_and_only_when_it_has_settled() {
    let mut flash = scene_flash();
    let mut memory = Memory::new();
    let mut desk = Desk::new(&mut memory);
    let mut keeper = SceneKeeper::new(SCENE_SLOT, 40_000, &flash, &mut desk.session);
    desk.greet();
    desk.load(&constant(0.01)).unwrap();
    let begun = u32::MAX - 1000; // the tick count may wrap
    for after in [0, 1, SETTLED_TICKS - 1] {
        keeper.step(&mut flash, &desk.session, begun.wrapping_add(after));
        assert_eq!(flash.done, 0);
    }
    settle(&mut keeper, &mut flash, &desk, begun.wrapping_add(SETTLED_TICKS));
    let done = flash.done;
    assert!(done > 0);
    desk.load(&constant(0.01)).unwrap();
    settle(&mut keeper, &mut flash, &desk, 0);
    assert_eq!(flash.done, done, "the same scene is not written again");
}

#[test]
fn nothing_is_written_unless_the_board_is_disarmed() {
    let mut flash = scene_flash();
    let mut memory = Memory::new();
    let mut desk = Desk::new(&mut memory);
    let mut keeper = SceneKeeper::new(SCENE_SLOT, 40_000, &flash, &mut desk.session);
    desk.greet();
    let kept = constant(0.01);
    desk.load(&kept).unwrap();
    settle(&mut keeper, &mut flash, &desk, 0);

    desk.load(&constant(0.02)).unwrap();
    desk.command(Command::Arm).unwrap();
    let done = flash.done;
    settle(&mut keeper, &mut flash, &desk, 0);
    desk.command(Command::Play).unwrap();
    settle(&mut keeper, &mut flash, &desk, 0);
    assert_eq!(flash.done, done);

    // Armed in the middle of a write: it ends there, and the copy before is still the one.
    desk.command(Command::Disarm).unwrap();
    desk.press_switch();
    keeper.step(&mut flash, &desk.session, 0);
    while flash.done < done + PAGE_LEN + 40 {
        keeper.step(&mut flash, &desk.session, SETTLED_TICKS);
    }
    desk.command(Command::Arm).unwrap();
    let done = flash.done;
    assert!(!flash.is_at_rest());
    settle(&mut keeper, &mut flash, &desk, 0);
    assert_eq!(flash.done, done);
    assert!(flash.is_at_rest(), "somebody has to see the operation to its end");
    let mut memory = Memory::new();
    let mut after = Desk::new(&mut memory);
    SceneKeeper::new(SCENE_SLOT, 40_000, &flash.after_power_on(), &mut after.session);
    assert_eq!(after.greet().scene_crc32, crc32(&kept));
}

#[test]
fn a_scene_that_the_board_can_no_longer_play_is_left_alone() {
    let mut flash = scene_flash();
    let mut memory = Memory::new();
    let mut desk = Desk::new(&mut memory);
    let mut keeper = SceneKeeper::new(SCENE_SLOT, 40_000, &flash, &mut desk.session);
    desk.greet();
    let scene = textured(&mut desk);
    desk.load(&scene).unwrap();
    settle(&mut keeper, &mut flash, &desk, 0);

    let limits = BoardLimits { voltage_max_v_peak: 50.0, ..Board::SIMULATOR.limits };
    let mut memory = Memory::new();
    let mut desk = Desk::of(Board { limits, ..Board::SIMULATOR }, &mut memory);
    let keeper = SceneKeeper::new(SCENE_SLOT, 40_000, &flash, &mut desk.session);
    assert_eq!(keeper.settled_crc32(), None);
    assert_eq!((desk.greet().scene_crc32, desk.session.scene()), (0, None));
    // The whole pool is free.
    desk.upload_bitmap(256, 256, &vec![5; 64 * 1024]).unwrap();
}

/// What a good CRC stands over need not be good itself.
#[test]
fn a_bitmap_that_is_not_its_name_is_not_held() {
    let mut memory = Memory::new();
    let mut desk = Desk::new(&mut memory);
    desk.greet();
    let scene = textured(&mut desk);
    desk.load(&scene).unwrap();
    let kept = desk.session.scene_to_store().unwrap();
    let mut bytes: Vec<u8> = (0..kept.len_to_keep()).step_by(WORD_LEN).flat_map(|offset| kept.word(offset)).collect();
    let sample = bytes.len() - 16 - 100;
    bytes[sample] ^= 1;

    let mut memory = Memory::new();
    let mut desk = Desk::new(&mut memory);
    assert!(!desk.session.restore(|offset, word| {
        word.copy_from_slice(&bytes[offset as usize..][..word.len()]);
        true
    }));
    desk.greet();
    assert_eq!(desk.upload_bitmap(61, 53, &content(7, 61 * 53)), Ok(Accepted::Done));
}

#[test]
fn a_flash_that_fails_is_tried_once_for_each_scene() {
    let mut flash = scene_flash();
    flash.operations_fail = true;
    let mut memory = Memory::new();
    let mut desk = Desk::new(&mut memory);
    let mut keeper = SceneKeeper::new(SCENE_SLOT, 40_000, &flash, &mut desk.session);
    desk.greet();
    for (scene, failures) in [(constant(0.01), 1), (constant(0.01), 1), (constant(0.02), 2)] {
        desk.load(&scene).unwrap();
        settle(&mut keeper, &mut flash, &desk, 0);
        assert_eq!(keeper.failures(), failures);
    }
}

proptest! {
    /// Whatever a good CRC stands over: no panic, and no scene but a whole one.
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
        let mut memory = Memory::new();
        let mut desk = Desk::new(&mut memory);
        let restored = desk.session.restore(|offset, word| {
            let offset = offset as usize;
            match bytes.get(offset..offset + word.len()) {
                Some(found) => { word.copy_from_slice(found); true }
                None => false,
            }
        });
        prop_assert!(!restored);
        prop_assert_eq!(desk.greet().scene_crc32, 0);
    }
}
