//! Points of a study on other machines: as job arrays of Slurm, or by workers that another program starts.

use super::Outcome;
use super::cluster::{Elsewhere, Executor, absolute, keep_ledger, put_json};
use super::task::Task;
use crate::cluster::{ClusterError, Ledger, Need, Work};
use crate::store::{StoreError, Unfinished};
use crate::study::{Plan, PlannedPoint, Runs, Scene, StudyFolder, TaskRun};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// A study that other processes compute.
#[derive(Clone, Copy)]
pub(super) struct Study<'a> {
    pub scene: Scene<'a>,
    pub plan: &'a Plan,
    pub cache: Option<&'a Path>,
}

impl Study<'_> {
    /// Has other processes compute these runs, by point and repeat: gives them to Slurm and waits for them, or writes
    /// them for workers. Gives an outcome where the study ends here without its answer.
    pub fn perform(
        &self,
        folder: &StudyFolder,
        asked: &Elsewhere<'_>,
        runs: &[(usize, u32)],
    ) -> Result<Option<Outcome>, ClusterError> {
        let state = folder.directory().shared();
        let pieces = Pieces { study: self, state, needs: self.all_needs(), wanted: runs };
        match asked.arguments.executor {
            Executor::Local => Ok(None),
            Executor::Slurm => asked.watch(&pieces, state),
            Executor::Workers => asked.for_workers(&pieces).map(Some),
        }
    }

    /// What the runs of the first round take.
    pub fn needs(&self) -> Vec<Need> {
        self.needs_of(self.plan.study.repeats.least)
    }

    /// What every run takes that there may be, in the order of [`Pieces`].
    fn all_needs(&self) -> Vec<Need> {
        self.needs_of(self.plan.study.repeats.most)
    }

    fn needs_of(&self, repeats: u32) -> Vec<Need> {
        let of = |point: &PlannedPoint| Need { seconds: point.seconds, bytes: point.bytes, goes_on: false };
        self.plan.points.iter().flat_map(|point| (0..repeats).map(move |_| of(point))).collect()
    }
}

/// The runs of a study as pieces of work: those of the first point, those of the second one, and so on.
struct Pieces<'a> {
    study: &'a Study<'a>,
    state: &'a Unfinished,
    needs: Vec<Need>,
    /// Runs of this round, by point and repeat.
    wanted: &'a [(usize, u32)],
}

impl Pieces<'_> {
    fn point(&self, piece: usize) -> (&PlannedPoint, u32) {
        let most = self.study.plan.study.repeats.most;
        (&self.study.plan.points[piece / most as usize], piece as u32 % most)
    }
}

impl Work for Pieces<'_> {
    fn needs(&self) -> &[Need] {
        &self.needs
    }

    fn missing(&self) -> Result<BTreeSet<usize>, StoreError> {
        let kept = self.state.keys()?;
        let most = self.study.plan.study.repeats.most as usize;
        let wanted = self.wanted.iter().map(|(index, repeat)| index * most + *repeat as usize);
        let is_missing = |piece: &usize| {
            let (point, repeat) = self.point(*piece);
            !kept.contains(&point.key(repeat))
        };
        Ok(wanted.filter(is_missing).collect())
    }

    fn put(&self, task: usize, pieces: &[usize]) -> Result<(), StoreError> {
        let Study { scene, plan, cache, .. } = self.study;
        let run = |piece: &usize| {
            let (point, repeat) = self.point(*piece);
            TaskRun::new(point, repeat)
        };
        let runs = Runs {
            scene: absolute(Path::new(scene.name)),
            set: scene.set.to_vec(),
            study: plan.study.name.clone(),
            cache: cache.map(absolute),
            runs: pieces.iter().map(run).collect(),
        };
        put_json(self.state, &Task::key(task), &Task::Runs(runs))
    }

    fn keep(&self, ledger: &Ledger) -> Result<(), StoreError> {
        keep_ledger(self.state, ledger)
    }

    fn logs(&self) -> PathBuf {
        self.state.path().join(".trackbed/logs")
    }
}
