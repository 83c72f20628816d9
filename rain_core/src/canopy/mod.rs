//! Trees: interception, storage, free throughfall, drip and stemflow.
