//! Laws of counted work: more effort is no worse, and what ends a search is named.

use crate::common::{at, robot, scene, wall};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use trundle_core::{Footprint, Pose2};
use trundle_docking::corridor::{Problem, generate, parse};
use trundle_docking::{
    Certificate, DockingConfig, DockingPlan, DockingPlanner, Method, Obstacle, SearchLimit,
};

fn planner(mut config: DockingConfig) -> DockingPlanner {
    config.margin = 0.0;
    DockingPlanner::new(config).unwrap()
}

fn problems(seed: u64, count: usize) -> Vec<Problem> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    (0..count).map(|i| generate(format!("{i}"), &mut rng)).collect()
}

fn hard() -> Vec<Problem> {
    parse(include_str!("../data/hard.txt")).unwrap()
}

fn plan(planner: &DockingPlanner, problem: &Problem) -> DockingPlan {
    planner.plan(&problem.footprint, &problem.scene().unwrap(), problem.start, problem.goal).unwrap()
}

#[test]
fn more_boxes_never_lower_the_bound() {
    let planners = [0, 30, 300, 2000].map(|bound_boxes| {
        let mut config = DockingConfig::default();
        config.bound_boxes = bound_boxes;
        planner(config)
    });
    let mut raised = 0;
    for problem in problems(91, 12) {
        let scene = problem.scene().unwrap();
        let bounds = planners.each_ref().map(|planner| {
            planner.bound(&problem.footprint, &scene, problem.start, problem.goal, 1e3).unwrap()
        });
        assert!(bounds.windows(2).all(|pair| pair[1] >= pair[0] - 1e-9), "{}: {bounds:?}", problem.name);
        raised += usize::from(bounds[3] > bounds[0] + 0.1);
    }
    assert!(raised > 6, "{raised} of 12 bounds are raised");
}

#[test]
fn a_bound_is_never_above_the_known_time_and_rises_with_it() {
    let mut config = DockingConfig::default();
    config.bound_boxes = 200;
    let planner = planner(config);
    for problem in problems(92, 12) {
        let scene = problem.scene().unwrap();
        let bound = |known: f64| {
            planner.bound(&problem.footprint, &scene, problem.start, problem.goal, known).unwrap()
        };
        let bounds = [0.0, 1.0, 4.0, 1e3].map(|known| (known, bound(known)));
        assert!(bounds.iter().all(|(known, bound)| bound <= known), "{}: {bounds:?}", problem.name);
        assert!(bounds.windows(2).all(|pair| pair[1].1 >= pair[0].1 - 1e-9), "{}: {bounds:?}", problem.name);
    }
}

#[test]
fn without_any_grant_a_plan_waits_and_does_no_work() {
    let problem = &problems(93, 1)[0];
    let planner = planner(DockingConfig::default());
    let scene = problem.scene().unwrap();
    let mut job = planner.begin(0.0, &problem.footprint, &scene, problem.start, problem.goal).unwrap();
    let after_first = (job.advance(0), job.work());
    for _ in 0..100 {
        assert_eq!((job.advance(0), job.work()), after_first);
    }
    assert_eq!(after_first.0, None);
    assert!(job.advance(u64::MAX).is_some());
}

#[test]
fn any_division_of_the_work_gives_the_same_plan_for_the_same_work() {
    let mut rng = ChaCha8Rng::seed_from_u64(94);
    for method in [Method::Optimal, Method::Hong24] {
        let mut config = DockingConfig::default();
        config.method = method;
        let planner = planner(config);
        for problem in problems(95, 6) {
            let scene = problem.scene().unwrap();
            let begin =
                || planner.begin(0.0, &problem.footprint, &scene, problem.start, problem.goal).unwrap();
            let (mut whole, mut divided) = (begin(), begin());
            let at_once = whole.advance(u64::MAX).unwrap();
            let in_parts = loop {
                if let Some(plan) = divided.advance(rng.random_range(1..300_000)) {
                    break plan;
                }
            };
            assert_eq!((at_once, whole.work()), (in_parts, divided.work()), "{method:?} {}", problem.name);
        }
    }
}

#[test]
fn a_job_keeps_its_own_scene() {
    let planner = planner(DockingConfig::default());
    let mut job = {
        let short_lived = scene(&[wall((-2.0, 0.4), (2.0, 0.4))]);
        planner.begin(0.0, &robot(), &short_lived, Pose2::IDENTITY, Pose2::new(0.1, 0.1, 0.0)).unwrap()
    };
    assert!(format!("{job:?}").starts_with("PlanningJob { work: "));
    assert!(matches!(job.advance(u64::MAX), Some(DockingPlan::Found(_))));
}

#[test]
fn the_least_work_ends_a_hard_search_and_is_named() {
    let mut config = DockingConfig::default();
    config.max_work = 100_000;
    for problem in hard().iter().take(2) {
        let DockingPlan::Impossible(none) = plan(&planner(config.clone()), problem) else {
            panic!("{} is found with no work", problem.name)
        };
        assert_eq!((none.certificate, none.limit), (Certificate::None, Some(SearchLimit::MaxWork)));
        assert_eq!(none.by, None);
    }
}

#[test]
fn a_search_without_nodes_is_ended_by_them_and_names_them() {
    let mut config = DockingConfig::default();
    config.search_nodes = 0;
    let ended =
        hard().iter().take(2).map(|problem| plan(&planner(config.clone()), problem)).collect::<Vec<_>>();
    for plan in ended {
        let DockingPlan::Impossible(none) = plan else { panic!("{plan:?}") };
        assert_eq!((none.certificate, none.limit), (Certificate::None, Some(SearchLimit::SearchNodes)));
    }
}

#[test]
fn a_plan_found_with_less_effort_is_found_with_more_and_not_slower() {
    let efforts = [(0, 100_000), (500, 2_000_000), (2500, 50_000_000)];
    let planners = efforts.map(|(search_nodes, max_work)| {
        let mut config = DockingConfig::default();
        config.search_nodes = search_nodes;
        config.max_work = max_work;
        config.bound_boxes = 0;
        planner(config)
    });
    for problem in problems(96, 20) {
        let times = planners.each_ref().map(|planner| match plan(planner, &problem) {
            DockingPlan::Found(solution) => solution.manoeuvre.duration(),
            DockingPlan::Impossible(_) => f64::INFINITY,
        });
        assert!(times.windows(2).all(|pair| pair[1] <= pair[0] + 1e-9), "{}: {times:?}", problem.name);
    }
}

#[test]
fn a_proof_stays_a_proof_with_more_work() {
    let closed = [
        ((-1.0, -0.5), (-1.0, 0.5)),
        ((-1.0, 0.5), (1.0, 0.5)),
        ((1.0, 0.5), (1.0, -0.5)),
        ((1.0, -0.5), (-1.0, -0.5)),
    ];
    let scene = scene(&closed.map(|(a, b)| wall(a, b)));
    for max_work in [1_000_000, 10_000_000, 50_000_000] {
        let mut config = DockingConfig::default();
        config.max_work = max_work;
        let planner = planner(config);
        let plan = planner.plan(&robot(), &scene, Pose2::IDENTITY, Pose2::new(0.0, 1.5, 0.0)).unwrap();
        let DockingPlan::Impossible(none) = plan else { panic!("{plan:?}") };
        assert_eq!(none.certificate, Certificate::Never, "{max_work}");
    }
}

#[test]
fn the_setting_that_ends_a_plan_among_many_points_is_their_own() {
    let ring = |i: u32| {
        let (sin, cos) = (f64::from(i) * 0.01).sin_cos();
        Obstacle::Point(at(0.45 * cos, 0.45 * sin))
    };
    let scene = scene(&(0..629).map(ring).collect::<Vec<_>>());
    let mut config = DockingConfig::default();
    config.points_work = 100_000;
    let goal = Pose2::new(0.05, 0.0, 1.5);
    let plan = planner(config).plan(&robot(), &scene, Pose2::IDENTITY, goal).unwrap();
    if let DockingPlan::Impossible(none) = plan {
        assert!(
            none.certificate != Certificate::None || none.limit == Some(SearchLimit::PointsWork),
            "{none:?}"
        );
    }
}

#[test]
fn plans_do_not_depend_on_what_was_planned_before() {
    let planner = planner(DockingConfig::default());
    let problems = problems(97, 5);
    let first: Vec<_> = problems.iter().map(|problem| plan(&planner, problem)).collect();
    let again: Vec<_> = problems.iter().rev().map(|problem| plan(&planner, problem)).collect();
    assert!(first.iter().eq(again.iter().rev()));
    assert_eq!(planner.config().margin, 0.0);
    let disc = Footprint::KOBUKI;
    let far = planner.plan(&disc, &scene(&[]), Pose2::IDENTITY, Pose2::new(5.1, 0.0, 0.0)).unwrap_err();
    assert_eq!(far.to_string(), "the goal is 5.10 m away, expected at most 5.00 m: plan a path there first");
}
