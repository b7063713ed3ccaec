//! A tree of boxes over the facets of a mesh, for searches that need not check all facets.

use nalgebra::Vector3;

/// Facets in a box that is not split further.
const LEAF: usize = 4;

/// A tree halves its facets at every level, so no mesh that fits its numbers is deeper.
const DEPTH: usize = 64;

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tree {
    /// A parent is before its first half, and the first half is before the second.
    nodes: Vec<Node>,
    /// Facets; the facets of a leaf are contiguous.
    facets: Vec<u32>,
}

#[derive(Debug, Clone, PartialEq)]
struct Node {
    low: Vector3<f64>,
    high: Vector3<f64>,
    next: Next,
}

#[derive(Debug, Clone, PartialEq)]
enum Next {
    /// The first half follows its parent, the second half begins at this index.
    Halves {
        second: u32,
    },
    Facets {
        start: u32,
        end: u32,
    },
}

/// A facet during the construction of the tree.
struct Item {
    facet: u32,
    low: Vector3<f64>,
    high: Vector3<f64>,
}

impl Item {
    fn middle(&self, axis: usize) -> f64 {
        self.low[axis] + self.high[axis]
    }
}

impl Tree {
    pub fn new(vertices: &[Vector3<f64>], triangles: &[[u32; 3]]) -> Self {
        let item = |(facet, corners): (usize, &[u32; 3])| {
            let [a, b, c] = corners.map(|v| vertices[v as usize]);
            Item { facet: facet as u32, low: a.inf(&b).inf(&c), high: a.sup(&b).sup(&c) }
        };
        let mut items: Vec<_> = triangles.iter().enumerate().map(item).collect();
        let mut tree = Self { nodes: Vec::with_capacity(items.len()), facets: Vec::with_capacity(items.len()) };
        tree.grow(&mut items);
        tree
    }

    fn grow(&mut self, items: &mut [Item]) {
        let low = items.iter().fold(items[0].low, |low, item| low.inf(&item.low));
        let high = items.iter().fold(items[0].high, |high, item| high.sup(&item.high));
        let start = self.facets.len() as u32;
        let node = self.nodes.len();
        self.nodes.push(Node { low, high, next: Next::Facets { start, end: start + items.len() as u32 } });
        if items.len() <= LEAF {
            self.facets.extend(items.iter().map(|item| item.facet));
            return;
        }
        let axis = (high - low).imax();
        let middle = items.len() / 2;
        items.select_nth_unstable_by(middle, |a, b| {
            a.middle(axis).total_cmp(&b.middle(axis)).then(a.facet.cmp(&b.facet))
        });
        let (first, second) = items.split_at_mut(middle);
        self.grow(first);
        self.nodes[node].next = Next::Halves { second: self.nodes.len() as u32 };
        self.grow(second);
    }

    pub fn bounds(&self) -> [Vector3<f64>; 2] {
        [self.nodes[0].low, self.nodes[0].high]
    }

    /// Calls `show` for every facet in boxes that `enter` accepts, by their lowest and highest corners.
    pub fn search(&self, enter: impl Fn(&Vector3<f64>, &Vector3<f64>) -> bool, mut show: impl FnMut(u32)) {
        let mut waiting = [0u32; DEPTH];
        let mut count = 1;
        while count > 0 {
            count -= 1;
            let number = waiting[count];
            let node = &self.nodes[number as usize];
            if !enter(&node.low, &node.high) {
                continue;
            }
            match node.next {
                Next::Halves { second } => {
                    waiting[count] = second;
                    waiting[count + 1] = number + 1;
                    count += 2;
                }
                Next::Facets { start, end } => self.facets[start as usize..end as usize].iter().for_each(|f| show(*f)),
            }
        }
    }
}
