//! Pictures of beds, read back as XML.

use super::*;
use crate::solvers::granular::{
    Bed, ContactLaw, ContactLaws, Dashpot, DashpotMode, FrictionLimit, Linear, Pose, WallId, WallMotion, shape::Mesh,
    shape::MeshKind,
};
use nalgebra::Vector3;

fn grain(x: f64, y: f64, z: f64, radius: f64, moved: f64) -> Grain {
    Grain {
        place: [x, y, z],
        radius,
        body: 0,
        velocity: [0.0, 0.0, 3.0 * moved],
        displacement: Some([moved, 0.0, 0.0]),
        coordination: 0,
        largest_force: 0.0,
    }
}

fn bed() -> Bed<f64> {
    let law = Linear {
        normal_stiffness: 1e6,
        shear_stiffness: 1e6,
        friction: 0.5,
        dashpot: Dashpot::Constant { normal: 0.0, shear: 0.0 },
        mode: DashpotMode::Full,
        limit: FrictionLimit::Spring,
    };
    Bed::new(Domain::open(), ContactLaws::single(ContactLaw::Linear(law)))
}

fn draw(grains: &[Grain], chains: &[Link], bed: &Bed<f64>, colour: Colour, side: Side) -> String {
    let (walls, domain) = (bed.walls(), bed.domain());
    bed_svg(&BedView { title: "a <bed>", grains, chains, walls, domain, side, colour })
}

/// Paint, place and radius of every ball, in the order of drawing.
fn balls(svg: &str) -> Vec<(String, f64, f64, f64)> {
    let document = roxmltree::Document::parse(svg).unwrap();
    let number = |n: &roxmltree::Node, name: &str| n.attribute(name).unwrap().parse::<f64>().unwrap();
    let circles = document.descendants().filter(|n| n.has_tag_name("circle"));
    circles
        .map(|n| (n.attribute("fill").unwrap().into(), number(&n, "cx"), number(&n, "cy"), number(&n, "r")))
        .collect()
}

#[test]
fn the_nearest_is_drawn_last_and_the_hidden_not_at_all() {
    // seen along y: the second hides the third, and half of the first
    let grains = [grain(0.0, 0.5, 0.0, 0.1, 1e-3), grain(0.1, 0.1, 0.0, 0.1, 2e-3), grain(0.1, 0.9, 0.02, 0.05, 3e-3)];
    let along = balls(&draw(&grains, &[], &bed(), Colour::Displacement, Side::X));
    assert_eq!(along.len(), 2);
    assert!(along[0].1 < along[1].1 && along[0].2 == along[1].2, "{along:?}");
    // to scale: two radii across three
    assert!((along[0].3 / (along[1].1 - along[0].1) - 1.0).abs() < 0.01, "{along:?}");
    // from the other side all are seen, the one of the largest x in front
    let across = balls(&draw(&grains, &[], &bed(), Colour::Displacement, Side::Y));
    assert_eq!(across.len(), 3);
    let middle = across[0].1;
    assert!((across[1].1 - middle) * (across[2].1 - middle) < 0.0, "{across:?}");
}

#[test]
fn colours_follow_the_value_and_what_has_none_is_grey() {
    let mut grains: Vec<Grain> = (0..5).map(|k| grain(f64::from(k), 0.0, 0.0, 0.4, 1e-3 * f64::from(k))).collect();
    grains[4].displacement = None;
    let mut drawn = balls(&draw(&grains, &[], &bed(), Colour::Displacement, Side::X));
    drawn.sort_by(|a, b| a.1.total_cmp(&b.1));
    let paints: Vec<&str> = drawn.iter().map(|ball| ball.0.as_str()).collect();
    assert_eq!(paints, ["url(#g0)", "url(#g8)", "url(#g16)", "url(#g23)", "url(#g24)"]);
    let svg = draw(&grains, &[], &bed(), Colour::Speed, Side::X);
    assert!(svg.contains("speed [mm/s]") && svg.contains("a &lt;bed&gt;"), "{svg}");
    // one outlier does not set the range of the colours, and is reported
    let mut many: Vec<Grain> = (0..200).map(|k| grain(f64::from(k), 0.0, 0.0, 0.4, 1e-3)).collect();
    many[7].displacement = Some([1.0, 0.0, 0.0]);
    let svg = draw(&many, &[], &bed(), Colour::Displacement, Side::X);
    assert!(svg.contains("displacement [mm]") && svg.contains("up to 1000"), "{svg}");
}

#[test]
fn walls_and_forces_are_drawn_where_they_are() {
    let mut bed = bed();
    bed.add_plane([0.0, 0.0, -0.1], [0.0, 0.0, 1.0], 0);
    bed.add_plane([0.0, 3.0, 0.0], [0.0, -1.0, 0.0], 0);
    let pose = Pose { position: Vector3::new(0.5, 0.0, 0.5), ..Pose::default() };
    bed.add_wall(Shape::Block { half: Vector3::repeat(0.1) }, pose, 0, WallMotion::Fixed);
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Vector3::from);
    let mesh = Mesh::new(corners.to_vec(), vec![[0, 1, 2]], MeshKind::TwoSided).unwrap();
    let last = bed.add_wall(Shape::Mesh(mesh), Pose::default(), 0, WallMotion::Fixed);
    assert_eq!(last, WallId(3));
    let grains = [grain(0.0, 0.0, 0.0, 0.1, 0.0), Grain { body: 1, ..grain(0.2, 0.0, 0.0, 0.1, 0.0) }];
    let link = |to: Option<u32>, force: f64| Link {
        from: grains[0].place,
        to: grains[1].place,
        bodies: (0, to),
        force: [-force, 0.0, 0.0],
        normal: [-1.0, 0.0, 0.0],
        overlap: 1e-6,
    };
    let links = [link(Some(1), 50.0), link(None, 100.0), link(Some(1), 0.01)];
    let svg = draw(&grains, &links, &bed, Colour::Force, Side::X);
    let document = roxmltree::Document::parse(&svg).unwrap();
    let of = |class: &str| document.descendants().filter(|n| n.attribute("class") == Some(class)).count();
    // the floor and twelve edges as lines, the triangle as a path; the plane behind the bed would cover it
    assert_eq!(of("wall"), 1 + 12 + 1);
    let chains = document.descendants().find(|n| n.attribute("class") == Some("chains")).unwrap();
    let widths: Vec<f64> = chains.children().map(|n| n.attribute("stroke-width").unwrap().parse().unwrap()).collect();
    // the strongest on top, the hair left out
    assert!(widths.len() == 2 && (widths[1] / widths[0] - 2.0).abs() < 0.01, "{widths:?}");
}

#[test]
fn an_empty_bed_is_a_picture_too() {
    let svg = draw(&[], &[], &bed(), Colour::Displacement, Side::X);
    assert!(roxmltree::Document::parse(&svg).is_ok() && balls(&svg).is_empty());
}
