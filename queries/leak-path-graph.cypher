// name: leak-path-graph
// kind: path
// description: Which paths lead from where a kind of data begins, at a source or where it is made, to its leaks?
// param category: category, only this category and narrower ones; all of them if it is empty, default ""
// param robot: robot, only this robot; all of them if it is empty, default ""
// returns robot: string, name of the robot where it begins
// returns category: string, the kind of data that arrives
// returns source: string, where it begins
// returns leak: string, where it gets out
// returns path: graph path, a shortest one that goes through no other leak of the category
// order: robot, category, source, leak
CALL db.relationshipTypes() YIELD relationshipType AS type
WITH type WHERE type STARTS WITH 'CARRIES_'
MATCH (c:DataCategory)
WHERE 'CARRIES' + toUpper(replace(c.label, '_', '')) = replace(type, '_', '')
      AND ($category = '' OR EXISTS { (c)-[:BROADER*0..]->(:DataCategory {name: $category}) })
WITH type, c.name AS category, c.label + 'Source' AS begins, c.label + 'Leak' AS leaks
MATCH (start:Element)
WHERE begins IN labels(start) AND ($robot = '' OR start.robot = $robot)
CALL (type, leaks, start) {
  MATCH path = SHORTEST 1 (start)-[first WHERE type(first) = type]->()
               ((x WHERE NOT leaks IN labels(x))-[r WHERE type(r) = type]->()){0,}
               (leak:Element WHERE leaks IN labels(leak))
  RETURN path, leak.name AS leak
}
WITH start.robot AS robot, category, start.name AS source, leak, path, [n IN nodes(path) | n.id] AS ids
ORDER BY length(path), ids
WITH robot, category, source, leak, collect(path)[0] AS path
RETURN robot, category, source, leak, path
ORDER BY robot, category, source, leak
