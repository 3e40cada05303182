#[test]
fn probe() {
    use super::*;
    let p = compile(&Scene::load(&scenes().join("brick.toml")).unwrap(), &LIMITS, TICK_HZ).unwrap();
    println!("{:?} {:?} {:?} {:?} {:?}", p.header, p.records, p.notes, p.reach, p.bitmaps[0].width);
    let e = compile_text(&format!("{HEAD}[[layer]]\nkind=\"constat\"\nfriction_m=3\n[[layer]]\nkind='grating'\nwavelenght_mm=3\nlow_n=0\nhigh_n=0.04\n[drve]\nx=1")).unwrap_err();
    println!("{e}");
    let e = compile_text(&format!("{HEAD}[[layer]]\nkind='grating'\nwavelength_mm=3\nlow_n=0\nhigh_n=0.04\n[[layer]]\nkind='bitmap'\npicture='textures/brik.png'\nx_mm=1\ny_mm=1\nwidth_mm=200\nblack_n=0\nwhite_n=0.03")).unwrap_err();
    println!("{e}");
    let e = compile_text("a = [1,\nb = }\n c = \"\nd = 3").unwrap_err();
    println!("{e}");
}
