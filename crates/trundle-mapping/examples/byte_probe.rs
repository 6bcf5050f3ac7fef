#![allow(clippy::all, clippy::print_stdout, clippy::unwrap_used, missing_docs, dead_code)]
#[path = "../tests/it/boxes.rs"]
mod boxes;
#[path = "../tests/it/building.rs"]
mod building;
use building::Building;
use std::hash::{Hash, Hasher};
use trundle_core::*;
use trundle_mapping::*;
fn h(b: &[u8]) -> u64 { let mut x = 0xcbf29ce484222325u64; for c in b { x = (x ^ *c as u64).wrapping_mul(0x100000001b3); } x }
fn grid(g: &OccupancyGrid) -> u64 { h(format!("{:?}", g).as_bytes()) }
fn main() {
    for (name, b) in [("ladder", Building::ladder()), ("rooms", Building::rooms()), ("blocks", Building::blocks())] {
        let drive = b.drive(1);
        let config = ParticleConfig { particles: 6, ..ParticleConfig::default() };
        let mut m = ParticleMapper::new(config.clone(), 1).unwrap();
        let mut live = LiveMapper::new(MapperConfig::default()).unwrap();
        let matcher = ScanMatcher::new(ScanMatchConfig::default()).unwrap();
        let mut text = String::new();
        let mut mt = String::new();
        let n = drive.odom.len().min(if name == "ladder" { 2500 } else { 700 });
        let mut bends = 0;
        for i in 0..n {
            let up = m.update(drive.odom[i], &drive.scans[i]);
            if let ScanUpdate::Processed(p) = up { bends += usize::from(p.bent.is_some()); text += &format!("{:?} {:?} {:?} {:?} {:?}", p.explained, p.degenerate, p.covariance, p.effective, p.slipped); }
            if i % 5 == 0 && i < 700 {
                let t = drive.truth[i];
                if i > 20 { mt += &format!("{:?}", matcher.refine(live.mapper(), &drive.scans[i], t * Pose2::new(0.05, -0.03, 0.02))); }
                live.insert(t, &drive.scans[i]);
                live.mark_free_disc(t, 0.18);
                if i % 200 == 0 { live.mark_occupied(t, &[Vector2::new(0.2, 0.0)]); live.correct(|_, p| p * Pose2::new(0.01, 0.0, 0.001)); }
                live.work(3000);
            }
        }
        let mid = m.save();
        let again = ParticleMapper::load(&mid, config.clone()).unwrap().save();
        m.finish();
        println!("{name} bends {bends} updates {:x} save {:x} again {} end {:x} grid {:x} traj {:x} bytes {}", h(text.as_bytes()), h(&mid), mid == again, h(&m.save()), grid(m.grid()), h(format!("{:?}", m.trajectory()).as_bytes()), m.bytes());
        println!("{name} live {:x} rev {} match {:x}", grid(live.grid()), live.revision(), h(mt.as_bytes()));
        let mut loc = MapLocalizer::of(&m, 3);
        let mut lt = String::new();
        for i in 0..60 { lt += &format!("{:?}", loc.update(drive.odom[i], &drive.scans[i])); }
        let mut loc2 = MapLocalizer::from_grid(m.grid(), config.clone(), 3).unwrap();
        for i in 0..30 { lt += &format!("{:?}", loc2.update(drive.odom[i], &drive.scans[i])); }
        println!("{name} loc {:x}", h(lt.as_bytes()));
        let mut again = ParticleMapper::load(&m.save(), config).unwrap();
        again.kidnapped();
        let mut lt = String::new();
        for i in 0..40 { lt += &format!("{:?}", again.update(drive.odom[i], &drive.scans[i])); }
        println!("{name} restart {:x} {:x}", h(lt.as_bytes()), h(&again.save()));
    }
}
