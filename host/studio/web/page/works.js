// The pieces of work that the browser keeps, so that no reload, crash or other scene loses one: in IndexedDB, one entry
// for each.
// @ts-check

const DATABASE = "frixel-studio";
const STORE = "works";
/** For so long a page waits for the lock of its own piece of work, which the page before a reload may still hold, ms. */
const RELEASE_MAX_MS = 1000;

/**
 * A piece of work: `changedMs` since 1970, `isEdited` whether it was changed since it was opened, `zip` as archive.js
 * packs it, and `picture` that of its map.
 * @typedef {{
 *   id: string, name: string, changedMs: number, isEdited: boolean, zip: Uint8Array, picture: Blob | null,
 * }} Work
 */

export class Works {
  /** @type {Promise<IDBDatabase> | undefined} */
  #database;
  /**
   * The piece of work that this page has: its id, and what ends its lock.
   * @type {{ id: string, release: () => void } | undefined}
   */
  #own;

  /** @param {Work} work */
  put(work) {
    return this.#run("readwrite", (store) => store.put(work));
  }

  /**
   * @param {string} id
   * @returns {Promise<Work | undefined>}
   */
  get(id) {
    return this.#run("readonly", (store) => store.get(id));
  }

  /** @param {string} id */
  delete(id) {
    return this.#run("readwrite", (store) => store.delete(id));
  }

  /**
   * All of them, that which was changed last first.
   * @returns {Promise<Work[]>}
   */
  async all() {
    const works = await this.#run("readonly", (store) => store.getAll());
    return works.sort((one, other) => other.changedMs - one.changedMs);
  }

  /**
   * Takes a piece of work for this page, and lets go of the one that it had. Resolves to false if another page has it:
   * two pages never write the same entry. With `waits`, the page before a reload has a moment to let go of it.
   * @param {string} id
   * @returns {Promise<boolean>}
   */
  async claim(id, { waits = false } = {}) {
    if (this.#own?.id === id) return true;
    const options = waits ? { signal: AbortSignal.timeout(RELEASE_MAX_MS) } : { ifAvailable: true };
    return new Promise((resolve) => {
      const hold = (/** @type {Lock | null} */ lock) => {
        resolve(lock !== null);
        if (lock === null) return undefined;
        this.#own?.release();
        return new Promise((/** @type {(value: void) => void} */ release) => (this.#own = { id, release }));
      };
      navigator.locks.request(`${DATABASE} ${id}`, options, hold).catch(() => resolve(false));
    });
  }

  /**
   * @template Value
   * @param {IDBTransactionMode} mode
   * @param {(store: IDBObjectStore) => IDBRequest<Value>} act
   * @returns {Promise<Value>}
   */
  async #run(mode, act) {
    this.#database ??= opened();
    const transaction = (await this.#database).transaction(STORE, mode);
    const request = act(transaction.objectStore(STORE));
    return new Promise((resolve, reject) => {
      transaction.oncomplete = () => resolve(request.result);
      transaction.onabort = () => reject(transaction.error);
      // A page that closes waits for nothing.
      transaction.commit();
    });
  }
}

/** @returns {Promise<IDBDatabase>} */
function opened() {
  return new Promise((resolve, reject) => {
    const request = indexedDB.open(DATABASE, 1);
    request.onupgradeneeded = () => request.result.createObjectStore(STORE, { keyPath: "id" });
    request.onsuccess = () => resolve(request.result);
    request.onerror = () => reject(request.error);
  });
}
