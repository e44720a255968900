# SPDX-License-Identifier: BSD-3-Clause
"""A data set by Dask's workers on this machine; on a cluster, the address of its scheduler in place of LocalCluster.

    python data_set_by_dask.py recipe.json set
"""

import sys

from dask.distributed import Client, LocalCluster
from petzval import dataset

if __name__ == "__main__":
    recipe, folder = sys.argv[1:]
    with LocalCluster(n_workers=2, threads_per_worker=1) as cluster, Client(cluster) as client:
        print(dataset.compute(client, recipe, folder))
        print(dataset.verify(folder) or "whole")
