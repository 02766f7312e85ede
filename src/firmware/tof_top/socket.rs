//! The estimator's socket: one of three has the clock, and its outputs are the socket's.

use crate::firmware::centroid_estimator::Registers;
use crate::firmware::{centroid_estimator, depth_estimator, likelihood_estimator};

use super::{Estimator, Params, Socket, TofTop};

impl TofTop {
    /// The estimator in the socket.
    #[inline(always)]
    pub(super) fn estimate(
        &mut self,
        p: &Params,
        network: &depth_estimator::In,
        centroid: &centroid_estimator::In,
        likelihood: &likelihood_estimator::In,
    ) {
        match p.estimator {
            Estimator::Network => self.depth_estimator.rise(network, &p.depth_estimator),
            Estimator::Centroid => self.centroid_estimator.rise(centroid, &p.centroid_estimator),
            Estimator::Likelihood => {
                self.likelihood_estimator.rise(likelihood, &p.likelihood_estimator);
            }
        }
        self.take_depth(p);
    }

    /// The socket's outputs, from the estimator's registers.
    #[inline(always)]
    fn take_depth(&mut self, p: &Params) {
        self.socket = match p.estimator {
            Estimator::Network => {
                let (ctrl, depth) =
                    (&self.depth_estimator.estimator_ctrl, self.depth_estimator.forward2.depth);
                let (read_en, read_addr) = (ctrl.read_en, ctrl.read_addr);
                Socket { read_en, read_addr, depth, algo_done: ctrl.algo_done }
            }
            Estimator::Centroid => {
                let Registers { read_en, read_addr, depth, algo_done, .. } =
                    self.centroid_estimator.registers;
                Socket { read_en, read_addr, depth, algo_done }
            }
            Estimator::Likelihood => {
                let memory = &self.likelihood_estimator.likelihood_memory.registers;
                let (read_en, read_addr) = (memory.read_en, memory.read_addr);
                let now = &self.likelihood_estimator.registers;
                Socket { read_en, read_addr, depth: now.depth, algo_done: now.algo_done }
            }
        };
    }
}
