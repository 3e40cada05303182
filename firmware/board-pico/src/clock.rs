//! The clocks: core and peripherals at [`CORE_HZ`] and the ADC at 48 MHz, from the crystal of 12 MHz, and the watchdog
//! from the chip's ring oscillator.

use rp_pac::clocks::vals::{ClkAdcCtrlAuxsrc, ClkPeriCtrlAuxsrc, ClkRefCtrlSrc, ClkSysCtrlAuxsrc, ClkSysCtrlSrc};
use rp_pac::pll::Pll;
use rp_pac::resets::regs::Peripherals;
use rp_pac::xosc::vals::{CtrlFreqRange, Enable};
use rp_pac::{CLOCKS, PLL_SYS, PLL_USB, RESETS, XOSC};

pub use crate::chip::CORE_HZ;
use crate::{chip, wait_until};

const CRYSTAL_HZ: u32 = 12_000_000;
/// Cycles of the crystal until it counts as stable, in units of 256: 5 ms.
const CRYSTAL_START: u16 = (CRYSTAL_HZ / 200 / 256) as u16;

/// Settings of a PLL: the crystal's frequency, multiplied and divided.
pub(crate) struct PllSettings {
    pub(crate) multiply: u16,
    pub(crate) divide: [u8; 2],
}

impl PllSettings {
    const fn hz(&self) -> u32 {
        CRYSTAL_HZ * self.multiply as u32 / self.divide[0] as u32 / self.divide[1] as u32
    }
}

/// Settings of the ADC's PLL: 48 MHz, the clock that the ADC requires (RP2040, 4.9, "ADC and Temperature Sensor").
const PLL_ADC: PllSettings = PllSettings { multiply: 100, divide: [5, 5] };

const _: () = assert!(chip::PLL.hz() == CORE_HZ && PLL_ADC.hz() == 48_000_000);

/// Switches to the crystal and from it to the PLLs (RP2040, 2.15, "Clocks"; 2.16, "Crystal Oscillator"; 2.18, "PLL").
pub fn start() {
    start_crystal();
    // The boot ROM may have left the core running from a PLL.
    CLOCKS.clk_sys_ctrl().modify(|w| w.set_src(ClkSysCtrlSrc::CLK_REF));
    wait_until(|| selected_sys() == 1, "the reference as clock of the core");
    CLOCKS.clk_ref_ctrl().modify(|w| w.set_src(ClkRefCtrlSrc::XOSC_CLKSRC));
    wait_until(|| selected_ref() == 1 << ClkRefCtrlSrc::XOSC_CLKSRC as u32, "the crystal as reference");

    start_pll(PLL_SYS, Peripherals::set_pll_sys, &chip::PLL);
    start_pll(PLL_USB, Peripherals::set_pll_usb, &PLL_ADC);
    prepare_for_speed();
    CLOCKS.clk_sys_ctrl().modify(|w| w.set_auxsrc(ClkSysCtrlAuxsrc::CLKSRC_PLL_SYS));
    CLOCKS.clk_sys_ctrl().modify(|w| w.set_src(ClkSysCtrlSrc::CLKSRC_CLK_SYS_AUX));
    wait_until(|| selected_sys() == 1 << ClkSysCtrlSrc::CLKSRC_CLK_SYS_AUX as u32, "the PLL as clock of the core");
    CLOCKS.clk_peri_ctrl().write(|w| {
        w.set_auxsrc(ClkPeriCtrlAuxsrc::CLK_SYS);
        w.set_enable(true);
    });
    CLOCKS.clk_adc_ctrl().write(|w| {
        w.set_auxsrc(ClkAdcCtrlAuxsrc::CLKSRC_PLL_USB);
        w.set_enable(true);
    });
    start_watchdog_ticks();
}

/// Enables the peripherals that the board uses, except the pins, in their reset state. A partial reset, such as a
/// debugger's, leaves them running.
pub fn start_peripherals() {
    restart(|w, is_reset| {
        w.set_adc(is_reset);
        w.set_pio0(is_reset);
        w.set_pio1(is_reset);
        w.set_pwm(is_reset);
        w.set_uart0(is_reset);
    });
}

/// Resets peripherals, and takes them out of reset again; `set` sets their bits.
pub(crate) fn restart(set: impl Fn(&mut Peripherals, bool)) {
    RESETS.reset().modify(|w| set(w, true));
    release(|w| set(w, false));
}

/// Takes peripherals out of reset, which `select` sets to `false`.
pub(crate) fn release(select: impl FnOnce(&mut Peripherals)) {
    let mut kept = Peripherals(!0);
    select(&mut kept);
    RESETS.reset().modify(|w| w.0 &= kept.0);
    wait_until(|| RESETS.reset_done().read().0 | kept.0 == !0, "the reset of a peripheral to end");
}

fn start_crystal() {
    XOSC.startup().write(|w| w.set_delay(CRYSTAL_START));
    XOSC.ctrl().write(|w| {
        w.set_freq_range(CtrlFreqRange::_1_15MHZ);
        w.set_enable(Enable::ENABLE);
    });
    wait_until(|| XOSC.status().read().stable(), "the crystal");
}

fn start_pll(pll: Pll, set_reset: fn(&mut Peripherals, bool), settings: &PllSettings) {
    restart(set_reset);
    pll.cs().modify(|w| w.set_refdiv(1));
    pll.fbdiv_int().write(|w| w.set_fbdiv_int(settings.multiply));
    pll.pwr().modify(|w| {
        w.set_pd(false);
        w.set_vcopd(false);
    });
    wait_until(|| pll.cs().read().lock(), "a PLL");
    let [first, second] = settings.divide;
    pll.prim().write(|w| {
        w.set_postdiv1(first);
        w.set_postdiv2(second);
    });
    pll.pwr().modify(|w| w.set_postdivpd(false));
}

/// Runs the watchdog's ticks from the ring oscillator, through the reference, which nothing else uses. They therefore
/// continue when the crystal stops (RP2040, 4.7.2, "Tick generation"; RP2350, 8.5, "Tick generators"). The data sheets
/// do not state whether the watchdog counts them without the chip's own clock. The ring oscillator is on, since the
/// boot ROM runs from it.
fn start_watchdog_ticks() {
    const CYCLES: u16 = (chip::RING_OSCILLATOR_MAX_HZ / 1_000_000) as u16;
    CLOCKS.clk_ref_ctrl().modify(|w| w.set_src(ClkRefCtrlSrc::ROSC_CLKSRC_PH));
    wait_until(|| selected_ref() == 1 << ClkRefCtrlSrc::ROSC_CLKSRC_PH as u32, "the ring oscillator as reference");
    #[cfg(feature = "rp2040")]
    rp_pac::WATCHDOG.tick().write(|w| {
        w.set_cycles(CYCLES);
        w.set_enable(true);
    });
    #[cfg(feature = "rp2350")]
    {
        rp_pac::TICKS.watchdog_cycles().write(|w| w.set_watchdog_cycles(CYCLES));
        rp_pac::TICKS.watchdog_ctrl().write(|w| w.set_enable(true));
    }
}

/// Supplies the core with 1.15 V, and slows the flash down to 50 MHz, since no code runs from it.
#[cfg(feature = "rp2040")]
fn prepare_for_speed() {
    const V_1_15: u8 = 0b1100;
    rp_pac::VREG_AND_CHIP_RESET.vreg().modify(|w| w.set_vsel(V_1_15));
    // The regulator takes less than 1 ms.
    cortex_m::asm::delay(CRYSTAL_HZ / 1000);
    rp_pac::SSI.ssienr().write(|w| w.set_ssi_en(false));
    rp_pac::SSI.baudr().write(|w| w.set_sckdv((CORE_HZ / 50_000_000) as u16));
    rp_pac::SSI.ssienr().write(|w| w.set_ssi_en(true));
}

/// Does nothing: the core voltage after a reset suffices for 150 MHz, and the boot ROM has slowed the flash down.
#[cfg(feature = "rp2350")]
fn prepare_for_speed() {}

/// The selected source of the core's clock, one bit per source.
fn selected_sys() -> u32 {
    let selected = CLOCKS.clk_sys_selected().read();
    #[cfg(feature = "rp2350")]
    let selected = selected.0;
    selected
}

/// The selected source of the reference, one bit per source.
fn selected_ref() -> u32 {
    let selected = CLOCKS.clk_ref_selected().read();
    #[cfg(feature = "rp2350")]
    let selected = selected.0;
    selected
}

/// A delay of this core.
pub type CycleDelay = frixel_cortex_m::CycleDelay<CORE_HZ>;
